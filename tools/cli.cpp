// The command line. CLI11 parses it into the structs that the commands take. The help texts are the manual.
#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>

#include "tools/commands.h"

namespace gim {
namespace {

constexpr int kWrongUsage = 2;

// Accepts 2^j + 1, from least to most.
CLI::Validator side_validator(uint32_t least, uint32_t most) {
    const auto check = [least, most](const std::string& text) -> std::string {
        uint32_t side = 0;
        if (!CLI::detail::lexical_cast(text, side) || side < least || side > most || ((side - 1) & (side - 2)) != 0) {
            return "must be a power of two plus one, " + std::to_string(least) + " to " + std::to_string(most) +
                   ", not " + text;
        }
        return {};
    };
    return {check, "2^j+1"};
}

CLI::Validator finite_range(double low, double high, const std::string& name) {
    const auto check = [low, high](const std::string& text) -> std::string {
        double value = 0;
        if (!CLI::detail::lexical_cast(text, value) || !(value >= low && value <= high)) {
            char message[120];
            std::snprintf(message, sizeof(message), "must be between %g and %g, not ", low, high);
            return message + text;
        }
        return {};
    };
    return {check, name};
}

// Reads "0.5", in object units, or "0.1%", of the diagonal. Returns nothing if the text is neither, or negative.
std::optional<Length> parse_length(std::string_view text) {
    Length length{0, text.ends_with('%')};
    if (length.in_diagonals) {
        text.remove_suffix(1);
        while (text.ends_with(' ')) text.remove_suffix(1);
    }
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), length.value);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    if (length.in_diagonals) length.value /= 100;
    return length.value >= 0 && std::isfinite(length.value) ? std::optional(length) : std::nullopt;
}

CLI::Validator length_validator(bool may_be_zero) {
    const auto check = [may_be_zero](const std::string& text) -> std::string {
        const std::optional<Length> length = parse_length(text);
        if (length && (may_be_zero || length->value > 0)) return {};
        return std::string("must be a length ") + (may_be_zero ? "of 0 or more" : "above 0") +
               ", as 0.5 or 0.1%, not " + text;
    };
    return {check, "LENGTH"};
}

struct EncodeArguments {
    EncodeCommand command;
    bool lossless = false;
    bool even = false;
    const CLI::Option* size = nullptr;
    std::optional<double> psnr, quality;
    std::string max_error, weld;
    std::optional<uint64_t> bytes;
    uint32_t normals = 0;
    std::optional<uint32_t> colors;
    std::optional<double> plane_quality;
};

// Options of an image: its layout, its size, what its samples are.
void add_image_options(CLI::App* sub, EncodeArguments& a) {
    static const std::map<std::string, Layout> layouts = {
        {"gim", Layout::kGim}, {"mcgim", Layout::kMcgim}, {"tiles", Layout::kTiles}, {"auto", Layout::kAuto}};
    sub->add_option("--layout", a.command.options.layout,
                    "gim: one square for each component; mcgim: several charts in one rectangle; tiles: a base mesh of "
                    "quads, not available yet; auto: the encoder chooses gim or mcgim")
        ->transform(CLI::CheckedTransformer(layouts).description(""))
        ->type_name("gim|mcgim|tiles|auto")
        ->default_str("gim");
    a.size = sub->add_option(
                    "--size", a.command.options.side,
                    "gim: samples per side; the next size has four times the samples. Default: 257, or with --psnr, "
                    "--max-error or --bytes a smaller size if its file is better")
                 ->check(side_validator(9, 4097));
    sub->add_option("--node-side", a.command.options.node_side,
                    "gim: side of the coarsest level that stays closed. The cut's nodes lie on a grid of this side, or "
                    "on a finer one if the cut needs it")
        ->check(side_validator(3, 4097))
        ->capture_default_str();
    sub->add_option("--samples", a.command.options.samples, "mcgim: most samples of the image, width * height")
        ->check(CLI::Range(1000, 1 << 26))
        ->capture_default_str();
    sub->add_option("--charts", a.command.options.charts,
                    "mcgim: number of charts. The encoder adds a few if the surface needs them. 0: the shape decides")
        ->check(CLI::Range(0, 4096))
        ->capture_default_str();
    sub->add_option("--bits", a.command.options.bits, "Bits per coordinate of the bounding box")
        ->check(CLI::Range(8, 20))
        ->capture_default_str();
}

// Options of cleaning.
void add_repair_options(CLI::App* sub, EncodeArguments& a) {
    sub->add_flag("--strict", a.command.options.strict,
                  "Refuse a surface that is no oriented manifold, and say where. Default: repair it, and say so");
    sub->add_option("--weld", a.weld,
                    "Weld boundary vertices that are not farther apart: in the mesh's unit, or with % of the diagonal "
                    "of its bounding box. Default: 0.0001%, with --strict 0")
        ->check(length_validator(true));
}

void add_rate_options(CLI::App* sub, EncodeArguments& a) {
    CLI::Option_group* rate = sub->add_option_group("rate", "How many bytes the samples may take (choose at most one)");
    rate->require_option(0, 1);
    rate->add_flag("--lossless", a.lossless, "Keep the quantized image exactly");
    rate->add_option("--psnr", a.psnr, "At least this PSNR in dB, of the decoded surface against the mesh")
        ->check(finite_range(1, 200, "DB"));
    rate->add_option("--max-error", a.max_error,
                     "At most this distance between the decoded surface and the mesh at any place, both ways: in the "
                     "mesh's unit, or with % of the diagonal of its bounding box. Checked after decoding")
        ->check(length_validator(false));
    rate->add_option("--bytes", a.bytes, "At most this size of the whole file")->check(CLI::PositiveNumber);
    rate->add_option("--quality", a.quality, "0 (smallest file) to 100 (finest); 10 more halve the quantizer step")
        ->check(finite_range(0, 100, "Q"));
}

void add_fit_options(CLI::App* sub, EncodeArguments& a) {
    static const std::map<std::string, FitStrength> fits = {{"auto", FitStrength::kAuto},
                                                            {"none", FitStrength::kOff},
                                                            {"stiff", FitStrength::kStiff},
                                                            {"loose", FitStrength::kLoose}};
    sub->add_option(
           "--fit", a.command.options.fit,
           "How far samples may move towards the surface. none: not at all; stiff: hardly any more bytes; loose: finds "
           "creases; auto: loose with --lossless, else stiff. auto also fits lossy squares to their quantizer")
        ->transform(CLI::CheckedTransformer(fits).description(""))
        ->type_name("auto|none|stiff|loose")
        ->default_str("auto");
    sub->add_flag("--even", a.even, "Spread samples evenly. Default: denser where the surface curves");
}

void add_plane_options(CLI::App* sub, EncodeArguments& a) {
    sub->add_option("--normals", a.normals,
                    "Store a normal map of the input with this side, rounded up to 2^j+1. 0: none (default)")
        ->check(CLI::Range(0, 4097))
        ->type_name("N");
    sub->add_option(
           "--colors", a.colors,
           "Store the input's vertex colours and textures in an image of this side, rounded up to 2^j+1. 0: none. "
           "Default: about as fine as the input's colours, up to 1025")
        ->check(CLI::Range(0, 4097))
        ->type_name("N");
    sub->add_option(
           "--plane-quality", a.plane_quality,
           "Quality of normal map and colours, 0 to 100 as in --quality. Both are always lossy. Default: the value of "
           "--quality, 90 with --lossless, else 75")
        ->check(finite_range(0, 100, "Q"));
}

void add_encode(CLI::App& app, EncodeArguments& a) {
    CLI::App* sub = app.add_subcommand("encode", "Turn a mesh into a .gim file");
    sub->footer(
        "MESH is PLY, OBJ, OFF, STL, glTF or GLB. The content tells the format, else the extension.\n"
        "The surface must be orientable, without non-manifold edges or vertices. gim first welds duplicate vertices\n"
        "and removes degenerate faces. In the layout gim, each connected component becomes an image of its own.\n"
        "MESH may also be a headerless geometry image named *.gim: float32, all x, then all y, then all z. The file\n"
        "size tells its side. gim imports it with the parametrization that it has.\n"
        "Choose at most one of --lossless, --psnr, --max-error, --bytes and --quality. Default: --quality 75.\n\n"
        "  gim encode bunny.ply bunny.gim\n"
        "  gim encode bunny.ply bunny.gim --size 513 --psnr 70\n"
        "  gim encode bunny.ply bunny.gim --max-error 0.5%\n"
        "  gim encode bunny.ply bunny.gim --lossless --bits 16 --json report.json\n"
        "  gim encode bunny.ply bunny.gim --size 129 --normals 512");
    sub->add_option("MESH", a.command.input, "Mesh to read")->required();
    sub->add_option("OUT", a.command.output, ".gim file to write")->required();
    add_image_options(sub, a);
    add_repair_options(sub, a);
    add_rate_options(sub, a);
    add_fit_options(sub, a);
    add_plane_options(sub, a);
    sub->add_option("--seed", a.command.options.seed, "Same seed, same bytes")->capture_default_str();
    sub->add_option("--threads", a.command.options.threads,
                    "Number of threads, 0: all cores. The bytes do not depend on it")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    sub->add_option("--json", a.command.json, "Write every figure of the run to this file (-: standard output)")
        ->type_name("REPORT");
    sub->add_option("--debug-dir", a.command.debug_folder,
                    "Write pictures of every state to this folder: the cut as it grows, the maps, the samples")
        ->type_name("DIR");
    sub->add_flag("--quiet", a.command.quiet, "Print no progress and no summary");
}

// Returns the smallest side of a plane that is at least `wanted`. 0 stays 0.
uint32_t plane_side(uint32_t wanted) {
    if (wanted == 0) return 0;
    uint32_t side = 5;
    while (side < wanted) side = 2 * side - 1;
    return side;
}

void apply_planes(EncodeArguments& a) {
    EncodeOptions& options = a.command.options;
    options.normal_side = plane_side(a.normals);
    if (a.colors) options.color_side = plane_side(*a.colors);
    options.plane_quality = a.plane_quality;
}

void apply_rate(EncodeArguments& a) {
    a.command.options.try_smaller_sides = a.size->count() == 0;
    RateTarget& rate = a.command.options.rate;
    if (a.lossless) rate = {RateTarget::Kind::kLossless, 0};
    if (a.psnr) rate = {RateTarget::Kind::kPsnr, *a.psnr};
    if (const auto length = parse_length(a.max_error))
        rate = {RateTarget::Kind::kMaxError, length->value, length->in_diagonals};
    a.command.options.weld_tolerance = parse_length(a.weld);
    if (a.bytes) rate = {RateTarget::Kind::kBytes, static_cast<double>(*a.bytes)};
    if (a.quality) rate = {RateTarget::Kind::kQuality, *a.quality};
}

void add_decode(CLI::App& app, DecodeCommand& c) {
    CLI::App* sub = app.add_subcommand("decode", "Turn a .gim file into a mesh or an EXR image");
    sub->footer(
        "The extension chooses the format. ply, obj and off share the vertices on the cut. glb repeats them, with\n"
        "equal positions, because texture coordinates jump there. exr holds the samples: float32 channels X, Y, Z\n"
        "and mask.\n"
        "Colours become vertex colours (ply, obj) or the base-colour texture (glb). A normal map becomes the normal\n"
        "texture (glb).\n\n"
        "  gim decode bunny.gim bunny.ply\n"
        "  gim decode bunny.gim bunny-129.glb --level 1\n"
        "  gim decode bunny.gim bunny.obj --normal-map normals.png --color-map colors.png");
    sub->add_option("IN", c.input, ".gim file to read")->required();
    sub->add_option("OUT", c.output, "File to write: .ply, .obj, .off, .stl, .glb or .exr")
        ->required()
        ->check(CLI::Validator(
            [](const std::string& path) -> std::string {
                for (const char* extension : {"ply", "obj", "off", "stl", "glb", "exr"}) {
                    if (path.size() > 4 && path[path.size() - 4] == '.' &&
                        CLI::detail::to_lower(path.substr(path.size() - 3)) == extension) {
                        return {};
                    }
                }
                return "'" + path + "' must end in .ply, .obj, .off, .stl, .glb or .exr";
            },
            ""));
    sub->add_option("--level", c.level, "Level to decode. 0: full resolution; each next level halves the sides")
        ->capture_default_str();
    const CLI::Validator picture(
        [](const std::string& path) -> std::string {
            const std::string end = path.size() > 4 ? CLI::detail::to_lower(path.substr(path.size() - 4)) : "";
            return end == ".png" || end == ".exr" ? "" : "'" + path + "' must end in .png or .exr";
        },
        "FILE");
    sub->add_option(
           "--normal-map", c.normal_map,
           "Write the file's normal map here, in object space: .png (16 bits, 0 to 65535 means -1 to 1) or .exr. "
           "Several images become FILE-0, FILE-1, ...")
        ->check(picture);
    sub->add_option(
           "--color-map", c.color_map,
           "Write the file's colours here: .png (sRGB) or .exr (linear). If OUT is an .obj, also write an .mtl "
           "beside it that names them")
        ->check(picture);
    sub->add_flag("--fused", c.fused, "GLB: share the vertices on the cut and leave out texture coordinates");
}

void add_info(CLI::App& app, InfoCommand& c) {
    CLI::App* sub = app.add_subcommand("info", "Describe a .gim file and check its bytes");
    sub->footer("The exit status is 1 if a chunk is damaged or missing, or if the file does not decode.");
    sub->add_option("IN", c.input, ".gim file to read")->required();
    sub->add_flag("--json", c.json, "Print JSON");
}

void add_compare(CLI::App& app, CompareCommand& c) {
    CLI::App* sub = app.add_subcommand("compare", "Measure the distance between two surfaces");
    sub->footer(
        "Either file may be a mesh or a .gim file.\n"
        "PSNR = 20 log10(diagonal / d). The diagonal is that of the reference's bounding box. d is the RMS distance\n"
        "from points of one surface to the other surface, weighted by area: both ways, the larger counts.\n"
        "Normals: the mean angle between shading normals. Samples are uniform by area, on both surfaces; each is\n"
        "compared with the nearest point of the other surface. Shading normals are interpolated between vertex\n"
        "normals. A vertex normal is the area-weighted mean of the triangles around all vertices at its position.\n"
        "Normals in the files do not count.\n"
        "Folded over: triangles of TEST that look away from the triangle of REFERENCE nearest to their centroid, and "
        "the\n"
        "share of TEST's area that does. Edges folded back: two triangles meet there at more than 150 degrees between\n"
        "their normals. Off by > 20, > 45: the share of TEST's area whose shading normal is off by more degrees. This\n"
        "angle and its percentiles take the angle-weighted mean for a vertex normal, as most renderers do. gim render\n"
        "--defects shows where the defects are.\n"
        "Vertices at equal positions are joined only if the format cannot share them (STL, glTF).\n"
        "In JSON, a PSNR of null means that the surfaces are equal.");
    sub->add_option("REFERENCE", c.reference, "Surface to compare with: mesh or .gim file")->required();
    sub->add_option("TEST", c.test, "Surface to judge: mesh or .gim file")->required();
    sub->add_option("--level", c.level, "Level to decode if TEST is a .gim file")->capture_default_str();
    sub->add_option("--samples", c.options.samples, "Samples on each surface")
        ->check(CLI::Range(1000, 100000000))
        ->capture_default_str();
    sub->add_option("--seed", c.options.seed, "Same seed, same figures")->capture_default_str();
    sub->add_option("--threads", c.options.threads, "Number of threads, 0: all cores. The figures do not depend on it")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    sub->add_flag("--json", c.json, "Print JSON");
}

void add_render(CLI::App& app, RenderCommand& c) {
    CLI::App* sub = app.add_subcommand("render", "Draw a mesh or a .gim file as a PNG");
    sub->footer(
        "Faces seen from behind are reddish.\n\n"
        "  gim render bunny.ply bunny.png\n"
        "  gim render bunny.ply all.png --gim bunny.gim     original, geometry image, reconstruction\n"
        "  gim render bunny.gim defects.png --defects bunny.ply --size 1024\n"
        "  gim render broken.ply look.png --flat --wire --azimuth 200");
    sub->add_option("IN", c.input, "Mesh or .gim file")->required();
    sub->add_option("OUT", c.output, "PNG to write")->required();
    sub->add_option("--gim", c.gim,
                    "Draw three panels: IN, this file's image (x y z as red green blue) and its surface");
    sub->add_option(
           "--defects", c.defects,
           "Compare the surface with this mesh or .gim file and paint it. Red: triangles folded over. Dark red: "
           "edges folded back. Orange: the shading normal is off by more than 45 degrees; pale yellow: by more "
           "than 20. Bluish: seen from behind. With --gim: paints that file's surface")
        ->type_name("REFERENCE");
    sub->add_option("--level", c.level, "Level of the .gim file to draw")->capture_default_str();
    sub->add_option("--size", c.size, "Pixels per side of a panel")->check(CLI::Range(16, 4096))->capture_default_str();
    sub->add_option("--up", c.up, "Axis that points up")
        ->check(CLI::IsMember({"auto", "x", "y", "z"}))
        ->capture_default_str();
    sub->add_option("--azimuth", c.azimuth, "Turn the model about the up axis, in degrees")
        ->check(finite_range(-360, 360, "DEG"))
        ->capture_default_str();
    sub->add_option("--elevation", c.elevation, "Look down from above, in degrees")
        ->check(finite_range(-90, 90, "DEG"))
        ->capture_default_str();
    sub->add_flag("--flat", c.flat, "Shade each triangle with one normal");
    sub->add_flag("--wire", c.wire, "Draw the edges");
}

}  // namespace

int report_error(const std::string& file, const Error& error) {
    const std::string stage(stage_name(error.stage));
    std::fprintf(stderr, "gim: %s: %s: %s\n", file.c_str(), stage.c_str(), error.message.c_str());
    return 1;
}

std::string with_thousands(uint64_t number) {
    std::string digits = std::to_string(number);
    for (size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, 1, ',');
    return digits;
}

void print_line(const std::string& text) { std::printf("%s\n", text.c_str()); }

int run_gim(int argc, const char* const* argv) {
    CLI::App app(
        "gim stores triangle meshes as geometry images. It turns a mesh into a small .gim file, and the file into a\n"
        "crack-free surface, at full resolution or coarser.");
    app.name("gim");
    app.set_version_flag("--version", std::string("gim ") + GIM_VERSION);
    app.require_subcommand(1);
    app.footer(
        "gim COMMAND --help describes a command.\n"
        "Exit status: 0 done, 1 the work failed, 2 wrong usage. Results go to stdout, messages and progress to "
        "stderr.");
    EncodeArguments encode_arguments;
    DecodeCommand decode_command;
    InfoCommand info_command;
    CompareCommand compare_command;
    RenderCommand render_command;
    add_encode(app, encode_arguments);
    add_decode(app, decode_command);
    add_info(app, info_command);
    add_compare(app, compare_command);
    add_render(app, render_command);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : kWrongUsage;
    }

    int exit_status = kWrongUsage;
    if (app.got_subcommand("encode")) {
        apply_rate(encode_arguments);
        apply_planes(encode_arguments);
        encode_arguments.command.options.density = !encode_arguments.even;
        exit_status = run_encode(encode_arguments.command);
    } else if (app.got_subcommand("decode")) {
        exit_status = run_decode(decode_command);
    } else if (app.got_subcommand("info")) {
        exit_status = run_info(info_command);
    } else if (app.got_subcommand("compare")) {
        exit_status = run_compare(compare_command);
    } else if (app.got_subcommand("render")) {
        exit_status = run_render(render_command);
    }
    // A full disk behind a redirected stdout is a failure too.
    if (std::fflush(stdout) != 0)
        return report_error("standard output", {Stage::kWrite, "cannot write the results; is the disk full?"});
    return exit_status;
}

}  // namespace gim

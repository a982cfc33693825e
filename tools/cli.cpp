// The command line: what CLI11 parses, into what the commands take. The help texts are the manual.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <map>

#include "tools/commands.h"

namespace gim {
namespace {

constexpr int kWrongUsage = 2;

// 2^j + 1, as the help says.
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

struct EncodeArguments {
    EncodeCommand command;
    bool lossless = false;
    bool even = false;
    const CLI::Option* size = nullptr;
    std::optional<double> psnr, quality;
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
                    "gim: the surface cut open onto one square; mcgim: charts; tiles: a base mesh of quads; auto")
        ->transform(CLI::CheckedTransformer(layouts).description(""))
        ->type_name("gim|mcgim|tiles|auto")
        ->default_str("gim");
    a.size =
        sub->add_option("--size", a.command.options.side,
                        "Samples per side; the next size has four times the samples; without it, 257, or less where "
                        "that meets --psnr or --bytes better")
            ->check(side_validator(9, 4097));
    sub->add_option("--node-side", a.command.options.node_side,
                    "Coarsest level that should stay closed: the cut's nodes lie on a grid of this side, or on a finer "
                    "one where the cut needs it")
        ->check(side_validator(3, 4097))
        ->capture_default_str();
    sub->add_option("--samples", a.command.options.samples, "mcgim: bound on width * height of the image")
        ->check(CLI::Range(1000, 1 << 26))
        ->capture_default_str();
    sub->add_option(
           "--charts", a.command.options.charts,
           "mcgim: how many charts; a few more come out where the surface asks for them; 0: chosen by the shape")
        ->check(CLI::Range(0, 4096))
        ->capture_default_str();
    sub->add_option("--bits", a.command.options.bits, "Bits per coordinate of the bounding box")
        ->check(CLI::Range(8, 20))
        ->capture_default_str();
}

void add_rate_options(CLI::App* sub, EncodeArguments& a) {
    CLI::Option_group* rate = sub->add_option_group("rate", "How many bytes the samples may take (at most one)");
    rate->require_option(0, 1);
    rate->add_flag("--lossless", a.lossless, "Keep the quantized image exactly");
    rate->add_option("--psnr", a.psnr, "At least this PSNR in dB, decoded surface against the mesh")
        ->check(finite_range(1, 200, "DB"));
    rate->add_option("--bytes", a.bytes, "At most this size of the whole file")->check(CLI::PositiveNumber);
    rate->add_option("--quality", a.quality, "0 (smallest) to 100 (finest); 10 more halve the quantizer step")
        ->check(finite_range(0, 100, "Q"));
}

void add_fit_options(CLI::App* sub, EncodeArguments& a) {
    static const std::map<std::string, FitStrength> fits = {{"auto", FitStrength::kAuto},
                                                            {"none", FitStrength::kOff},
                                                            {"stiff", FitStrength::kStiff},
                                                            {"loose", FitStrength::kLoose}};
    sub->add_option(
           "--fit", a.command.options.fit,
           "How far samples may move towards the surface: stiff costs hardly any bytes, loose finds creases; auto "
           "is loose for --lossless, else stiff, and fits lossy squares to their quantizer")
        ->transform(CLI::CheckedTransformer(fits).description(""))
        ->type_name("auto|none|stiff|loose")
        ->default_str("auto");
    sub->add_flag("--even", a.even, "Spread samples evenly, not denser where the surface curves");
}

void add_plane_options(CLI::App* sub, EncodeArguments& a) {
    sub->add_option("--normals", a.normals, "Side of a normal map of the input, rounded up to 2^j+1; 0: none")
        ->check(CLI::Range(0, 4097))
        ->type_name("N");
    sub->add_option(
           "--colors", a.colors,
           "Side of the image that takes the input's vertex colours and textures, rounded up to 2^j+1; 0: none; "
           "without it, about as fine as they are")
        ->check(CLI::Range(0, 4097))
        ->type_name("N");
    sub->add_option(
           "--plane-quality", a.plane_quality,
           "Quality of normal map and colours, as --quality; without it that of --quality, or 90 for --lossless "
           "(they are lossy all the same)")
        ->check(finite_range(0, 100, "Q"));
}

void add_encode(CLI::App& app, EncodeArguments& a) {
    CLI::App* sub = app.add_subcommand("encode", "Turn a mesh into a .gim file");
    sub->footer(
        "MESH is PLY, OBJ, OFF, STL, glTF or GLB, told apart by content, else by extension. It must be an\n"
        "orientable surface without non-manifold edges; duplicates are welded and degenerate faces removed first.\n"
        "Each connected component becomes an image of its own in the file.\n"
        "A headerless geometry image (planar float32 x, y, z; side from the size) named *.gim is imported as it is.\n"
        "At most one of --lossless, --psnr, --bytes and --quality; without any, --quality 75.\n\n"
        "  gim encode bunny.ply bunny.gim\n"
        "  gim encode bunny.ply bunny.gim --size 513 --psnr 70\n"
        "  gim encode bunny.ply bunny.gim --lossless --bits 16 --json report.json\n"
        "  gim encode bunny.ply bunny.gim --size 129 --normals 512");
    sub->add_option("MESH", a.command.input, "Mesh to read")->required();
    sub->add_option("OUT", a.command.output, ".gim file to write")->required();
    add_image_options(sub, a);
    add_rate_options(sub, a);
    add_fit_options(sub, a);
    add_plane_options(sub, a);
    sub->add_option("--seed", a.command.options.seed, "Same seed, same bytes")->capture_default_str();
    sub->add_option("--threads", a.command.options.threads, "0: all cores; the bytes do not depend on it")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    sub->add_option("--json", a.command.json, "Write every figure of the run to this file (-: standard output)")
        ->type_name("REPORT");
    sub->add_option("--debug-dir", a.command.debug_folder,
                    "Write pictures of every state to this folder: the cut as it grows, the maps, the samples")
        ->type_name("DIR");
    sub->add_flag("--quiet", a.command.quiet, "No progress and no summary");
}

// The smallest side that is not below.
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
    if (a.bytes) rate = {RateTarget::Kind::kBytes, static_cast<double>(*a.bytes)};
    if (a.quality) rate = {RateTarget::Kind::kQuality, *a.quality};
}

void add_decode(CLI::App& app, DecodeCommand& c) {
    CLI::App* sub = app.add_subcommand("decode", "Turn a .gim file into a mesh or an EXR image");
    sub->footer(
        "The extension chooses the format. ply, obj, off share the vertices on the cut; glb repeats them with equal\n"
        "positions, because texture coordinates jump there. exr holds the samples: float32 channels X, Y, Z and "
        "mask.\n"
        "Colours become vertex colours (ply, obj) or a base-colour texture (glb), a normal map the glb's normal "
        "texture.\n\n"
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
    sub->add_option("--level", c.level, "0: full resolution; each next level halves it")->capture_default_str();
    const CLI::Validator picture(
        [](const std::string& path) -> std::string {
            const std::string end = path.size() > 4 ? CLI::detail::to_lower(path.substr(path.size() - 4)) : "";
            return end == ".png" || end == ".exr" ? "" : "'" + path + "' must end in .png or .exr";
        },
        "FILE");
    sub->add_option(
           "--normal-map", c.normal_map,
           "Write the normals of the file here, in object space: .png (16 bits, 0 to 65535 is -1 to 1) or .exr; "
           "of several images FILE-0, FILE-1, ...")
        ->check(picture);
    sub->add_option("--color-map", c.color_map,
                    "Write the colours of the file here: .png (sRGB) or .exr (linear); with an .obj also OUT.mtl that "
                    "names it")
        ->check(picture);
    sub->add_flag("--fused", c.fused, "GLB: share the vertices on the cut, leave texture coordinates out");
}

void add_info(CLI::App& app, InfoCommand& c) {
    CLI::App* sub = app.add_subcommand("info", "Describe a .gim file and check its bytes");
    sub->footer("Exit status 1 where a chunk is damaged or missing, or the file does not decode.");
    sub->add_option("IN", c.input, ".gim file to read")->required();
    sub->add_flag("--json", c.json, "As JSON");
}

void add_compare(CLI::App& app, CompareCommand& c) {
    CLI::App* sub = app.add_subcommand("compare", "Measure the distance between two surfaces");
    sub->footer(
        "Either file may be a mesh or a .gim file. PSNR = 20 log10(diagonal / d): diagonal of the reference's "
        "bounding\n"
        "box, d the larger of the two one-way area-weighted RMS distances from points to the other surface.\n"
        "Normals: the mean angle between the shading normals of area-uniform samples and of the nearest points of the\n"
        "other surface. Shading normals are interpolated between vertex normals, those the area-weighted means of the\n"
        "triangles around all vertices at one position; normals in the files do not count.\n"
        "Vertices at equal positions are joined in formats that cannot share them (STL, glTF), not in others.\n"
        "In JSON, a PSNR of null means that the surfaces are equal.");
    sub->add_option("REFERENCE", c.reference, "What it should be")->required();
    sub->add_option("TEST", c.test, "What it is")->required();
    sub->add_option("--level", c.level, "Level of TEST where it is a .gim file")->capture_default_str();
    sub->add_option("--samples", c.options.samples, "Surface samples each way")
        ->check(CLI::Range(1000, 100000000))
        ->capture_default_str();
    sub->add_option("--seed", c.options.seed, "Same seed, same figures")->capture_default_str();
    sub->add_option("--threads", c.options.threads, "0: all cores; the figures do not depend on it")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    sub->add_flag("--json", c.json, "As JSON");
}

void add_render(CLI::App& app, RenderCommand& c) {
    CLI::App* sub = app.add_subcommand("render", "Draw a mesh or a .gim file as a PNG");
    sub->footer(
        "Faces seen from behind are reddish.\n\n"
        "  gim render bunny.ply bunny.png\n"
        "  gim render bunny.ply all.png --gim bunny.gim     original, geometry image, reconstruction\n"
        "  gim render broken.ply look.png --flat --wire --azimuth 200");
    sub->add_option("IN", c.input, "Mesh or .gim file")->required();
    sub->add_option("OUT", c.output, "PNG to write")->required();
    sub->add_option("--gim", c.gim, "Draw three panels: IN, this file's image (x y z as red green blue), its surface");
    sub->add_option("--level", c.level, "Level of the .gim file")->capture_default_str();
    sub->add_option("--size", c.size, "Pixels per side of a panel")->check(CLI::Range(16, 4096))->capture_default_str();
    sub->add_option("--up", c.up, "Axis that points up")
        ->check(CLI::IsMember({"auto", "x", "y", "z"}))
        ->capture_default_str();
    sub->add_option("--azimuth", c.azimuth, "Degrees, turns the model about the up axis")
        ->check(finite_range(-360, 360, "DEG"))
        ->capture_default_str();
    sub->add_option("--elevation", c.elevation, "Degrees, looks down from above")
        ->check(finite_range(-90, 90, "DEG"))
        ->capture_default_str();
    sub->add_flag("--flat", c.flat, "One normal per triangle");
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
        "gim: triangle meshes as geometry images. A mesh becomes a small .gim file, and the file becomes a\n"
        "crack-free surface again, at any resolution.");
    app.name("gim");
    app.set_version_flag("--version", std::string("gim ") + GIM_VERSION);
    app.require_subcommand(1);
    app.footer(
        "gim COMMAND --help tells more.\n"
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
    if (std::fflush(stdout) != 0) return report_error("standard output", {Stage::kWrite, "cannot write the results"});
    return exit_status;
}

}  // namespace gim

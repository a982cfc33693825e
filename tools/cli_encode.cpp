// The command line of gim encode. The help texts are the manual.
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "tools/cli_parts.h"
#include "tools/commands.h"

namespace gim {
namespace {

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
    const CLI::Option *layout = nullptr, *size = nullptr, *samples = nullptr, *node_side = nullptr, *charts = nullptr,
                      *tiles = nullptr;
    std::optional<double> psnr, quality;
    std::string max_error, weld, mask_channel, channels;
    std::optional<uint64_t> bytes;
    uint32_t normals = 0;
    std::optional<uint32_t> colors;
    std::optional<double> plane_quality;
};

// Options of an image: its layout, its size, what its samples are.
void add_image_options(CLI::App* sub, EncodeArguments& a) {
    static const std::map<std::string, Layout> layouts = {
        {"gim", Layout::kGim}, {"mcgim", Layout::kMcgim}, {"tiles", Layout::kTiles}, {"auto", Layout::kAuto}};
    a.command.options.layout = Layout::kAuto;
    a.layout =
        sub->add_option("--layout", a.command.options.layout,
                        "gim: one square for each component; mcgim: several charts in one rectangle; tiles: "
                        "square tiles on a base mesh of quads; auto: tries gim and tiles and keeps the smaller "
                        "file, or the better one for --bytes (at a --quality, the one that brief fits show to be "
                        "smaller at the same PSNR); with --lossless takes the layout that suits the "
                        "shape. An option that only one layout has chooses it. Default: auto")
            ->transform(CLI::CheckedTransformer(layouts).description(""))
            ->type_name("gim|mcgim|tiles|auto");
    a.size =
        sub->add_option(
               "--size", a.command.options.side,
               "gim: samples per side; several components share the samples of one such image. A cut that "
               "does not fit gets the next size, with a warning. Default: 257, or with --psnr, "
               "--max-error or --bytes a smaller size if its file is better. Takes about 1.4 GB of memory for each "
               "million samples: 1.6 GB at 1025, 6 GB at 2049, 24 GB at 4097")
            ->check(side_validator(9, 4097));
    a.node_side =
        sub->add_option("--node-side", a.command.options.node_side,
                        "gim: side of the coarsest level that stays closed, at most the size. The cut's nodes "
                        "lie on a grid of this side, or on a finer one if the cut needs it")
            ->check(side_validator(5, 4097))
            ->capture_default_str();
    a.samples =
        sub->add_option(
               "--samples", a.command.options.samples,
               "mcgim, tiles: most samples of the image, width * height. Charts that do not fit get more, with a "
               "warning. mcgim with --psnr, --max-error or --bytes: default: also fewer, if its file is better")
            ->check(CLI::Range(1000, 1 << 26))
            ->capture_default_str();
    a.charts = sub->add_option(
                      "--charts", a.command.options.charts,
                      "mcgim: number of charts. The encoder adds a few if the surface needs them. 0: the shape decides")
                   ->check(CLI::Range(0, 4096))
                   ->capture_default_str();
    a.tiles = sub->add_option(
                     "--tiles", a.command.options.tiles,
                     "tiles: number of tiles. The encoder makes more if the surface needs them. 0: the encoder decides")
                  ->check(CLI::Range(0, 65536))
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

// An option that only one layout has chooses it. Throws if two layouts are meant.
void apply_layout(EncodeArguments& a) {
    if (a.layout->count() > 0) return;
    Layout& layout = a.command.options.layout;
    const CLI::Option* chosen_by = nullptr;
    const auto choose = [&](const CLI::Option* option, Layout of_option) {
        if (option->count() == 0) return;
        if (chosen_by != nullptr && layout != of_option) {
            throw CLI::ValidationError(option->get_name(), "belongs to another layout than " + chosen_by->get_name() +
                                                               "; leave one of them out, or say --layout");
        }
        layout = of_option;
        chosen_by = option;
    };
    choose(a.size, Layout::kGim);
    choose(a.node_side, Layout::kGim);
    choose(a.charts, Layout::kMcgim);
    choose(a.tiles, Layout::kTiles);
}

void apply_rate(EncodeArguments& a) {
    const CLI::Option* size = a.command.options.layout == Layout::kMcgim ? a.samples : a.size;
    a.command.options.try_smaller_sides = size->count() == 0;
    RateTarget& rate = a.command.options.rate;
    if (a.lossless) rate = {RateTarget::Kind::kLossless, 0};
    if (a.psnr) rate = {RateTarget::Kind::kPsnr, *a.psnr};
    if (const auto length = parse_length(a.max_error))
        rate = {RateTarget::Kind::kMaxError, length->value, length->in_diagonals};
    a.command.options.weld_tolerance = parse_length(a.weld);
    if (a.bytes) rate = {RateTarget::Kind::kBytes, static_cast<double>(*a.bytes)};
    if (a.quality) rate = {RateTarget::Kind::kQuality, *a.quality};
}

void add_file_options(CLI::App* sub, EncodeArguments& a) {
    sub->add_option("MESH", a.command.input, "Mesh to read (-: standard input)")->required();
    sub->add_option("OUT", a.command.output, ".gim file to write (-: standard output), or .glb")->required();
}

void add_refit_option(CLI::App* sub, EncodeArguments& a) {
    sub->add_option(
           "--refit", a.command.refit,
           "Image: fit its samples to this mesh, which it must show in the same coordinates. --psnr and "
           "--max-error then count against the mesh. With --lossless the samples are fitted first and then kept "
           "exactly. --fit says how far samples move; auto: stiff if there are channels besides x y z. Default: "
           "no sample moves")
        ->type_name("MESH");
}

void add_glb_options(CLI::App* sub, EncodeArguments& a) {
    sub->add_flag("--fallback", a.command.fallback,
                  "GLB: also write plain arrays to OUT.fallback.bin, for readers that do not know the extension. Other "
                  "readers do not fetch that file");
}

// Options of how the work is done, and of how the input is read.
void add_work_options(CLI::App* sub, EncodeArguments& a, uint32_t threads) {
    add_mesh_format(sub, a.command.format,
                    "Format of MESH. Default: its content tells, else its extension. gim: a headerless image");
    sub->add_option("--effort", a.command.options.effort,
                    "1: fastest to 9: smallest file. Below 4, auto does not try tiles. Lossless files stay the same")
        ->check(CLI::Range(1, 9))
        ->type_name("1..9")
        ->capture_default_str();
    sub->add_option("--seed", a.command.options.seed, "Same seed, same bytes")->capture_default_str();
    a.command.options.threads = threads;
    sub->add_option("--threads", a.command.options.threads,
                    "Number of threads, 0: all cores. The bytes do not depend on it")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    add_max_memory(sub, a.command.max_memory);
}

// Options of images of other programs.
void add_raster_options(CLI::App* sub, EncodeArguments& a) {
    sub->add_option(
           "--mask-channel", a.mask_channel,
           "Image: which channel is the mask, from 0 on; none: all are data. Default: an array 'mask', else NaN, "
           "else channel 3 if there is one")
        ->type_name("K|none")
        ->check(CLI::Validator(
            [](const std::string& text) -> std::string {
                const bool is_number =
                    !text.empty() && text.size() < 6 && text.find_first_not_of("0123456789") == std::string::npos;
                return is_number || text == "none" ? "" : "must be a number or none, not " + text;
            },
            "K|none"));
    sub->add_option("--channels", a.channels,
                    "Image: which axis of the array holds the channels. Default: the shape tells")
        ->check(CLI::IsMember({"first", "last"}))
        ->type_name("first|last");
}

void apply_raster(EncodeArguments& a) {
    RasterOptions& raster = a.command.raster;
    raster.no_mask = a.mask_channel == "none";
    if (!a.mask_channel.empty() && !raster.no_mask)
        raster.mask_channel = static_cast<uint32_t>(std::stoul(a.mask_channel));
    if (!a.channels.empty()) raster.is_channels_first = a.channels == "first";
}

void add_report_options(CLI::App* sub, EncodeArguments& a) {
    sub->add_option("--json", a.command.json, "Write every figure of the run to this file (-: standard output)")
        ->type_name("REPORT");
    sub->add_option("--debug-dir", a.command.debug_folder,
                    "Write pictures of every state to this folder: the cut as it grows, the maps, the samples")
        ->type_name("DIR");
    sub->add_flag("--quiet", a.command.quiet, "Print no progress and no summary");
}

// All options that say how a mesh becomes a file.
void add_all_options(CLI::App* sub, EncodeArguments& a, uint32_t threads) {
    add_image_options(sub, a);
    add_repair_options(sub, a);
    add_rate_options(sub, a);
    add_fit_options(sub, a);
    add_plane_options(sub, a);
    add_raster_options(sub, a);
    add_work_options(sub, a, threads);
}

EncodeCommand command_of(EncodeArguments& a) {
    apply_layout(a);
    apply_rate(a);
    apply_planes(a);
    apply_raster(a);
    a.command.options.density = !a.even;
    return a.command;
}

}  // namespace

std::function<EncodeCommand()> add_encoding(CLI::App* sub, uint32_t threads) {
    const auto arguments = std::make_shared<EncodeArguments>();
    add_all_options(sub, *arguments, threads);
    return [arguments] { return command_of(*arguments); };
}

Subcommand add_encode(CLI::App& app) {
    const auto arguments = std::make_shared<EncodeArguments>();
    EncodeArguments& a = *arguments;
    CLI::App* sub = app.add_subcommand("encode", "Turn a mesh into a .gim file, or the meshes of a GLB");
    sub->footer(
        "MESH is PLY, OBJ, OFF, STL, glTF or GLB. The content tells the format, else the extension. glTF is read in\n"
        "the file's own pose: morph weights and skins apply, animations do not. Draco and meshopt are decompressed.\n"
        "gim repairs what is no oriented manifold, and says what it did: it welds vertices, joins faces in pairs, "
        "splits\n"
        "points where parts touch, drops faces without area, turns faces over. --strict refuses such a surface "
        "instead.\n"
        "In the layout gim, each connected component becomes an image of its own.\n"
        "Tiles keep hard edges sharp: those that the normals of OBJ, PLY and glTF and the smoothing groups of OBJ\n"
        "name. If these smooth everything or nothing, the shape tells which edges are hard.\n"
        "MESH may also be a headerless geometry image named *.gim: float32, all x, then all y, then all z. The file\n"
        "size tells its side. gim imports it with the parametrization that it has.\n"
        "MESH may also be a multi-chart image of another program, as .npz or .exr: x y z of each sample, a mask, "
        "other\n"
        "channels. Each sample stays where it is, unless --refit names the mesh. With --lossless whole numbers are "
        "exact, and floats are rounded to\n"
        "--bits of the bounding box. Borders that coincide are glued. gim decode OUT.gim BACK.npz gives the image "
        "back.\n"
        "If OUT is a .glb and MESH is glTF, the scene stays: nodes, materials, animations, cameras, lights. Each mesh\n"
        "becomes a .gim in it (extension EXT_gim_geometry), with the options for each of them. A mesh that gim cannot\n"
        "carry stays as it is, with a warning: skinned, with morph targets, points, lines, smaller than its .gim.\n"
        "gim decode makes a plain glTF of it.\n"
        "Two names of one file are refused. If OUT is standard output, the summary goes to stderr.\n"
        "Choose at most one of --lossless, --psnr, --max-error, --bytes and --quality. Default: --quality 75.\n\n"
        "  gim encode bunny.ply bunny.gim\n"
        "  gim encode bunny.ply bunny.gim --size 513 --psnr 70\n"
        "  gim encode bunny.ply bunny.gim --max-error 0.5%\n"
        "  gim encode bunny.ply bunny.gim --lossless --bits 16 --json report.json\n"
        "  gim encode bunny.ply bunny.gim --size 129 --normals 512\n"
        "  gim encode atlas.npz atlas.gim --lossless\n"
        "  gim encode atlas.npz atlas.gim --refit bunny.ply --psnr 70\n"
        "  gim encode scene.glb small.glb --psnr 70\n"
        "  zcat bunny.ply.gz | gim encode - bunny.gim\n"
        "  gim batch meshes packed --psnr 70     all meshes of a folder");
    add_file_options(sub, a);
    add_all_options(sub, a, a.command.options.threads);
    add_refit_option(sub, a);
    add_glb_options(sub, a);
    add_report_options(sub, a);
    return {sub, [arguments] { return run_encode(command_of(*arguments)); }};
}

}  // namespace gim

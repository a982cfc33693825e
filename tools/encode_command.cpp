// gim encode: reads a mesh (or a headerless geometry image), runs the encoder, writes the file and the figures.
#include <array>
#include <cstdio>
#include <utility>

#include "gim/refit.h"
#include "tools/commands.h"
#include "tools/companions.h"
#include "tools/file.h"
#include "tools/input.h"
#include "tools/output_files.h"
#include "tools/progress.h"
#include "tools/report_json.h"
#include "tools/state_pictures.h"

namespace gim {
namespace {

std::string format_line(const char* label, const std::string& value) {
    std::string line = label;
    line.resize(26, ' ');
    return line + value;
}

std::string fixed(double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof(text), "%.*f", digits, value);
    return text;
}

std::string scientific(double value) {
    char text[64];
    std::snprintf(text, sizeof(text), "%.4g", value);
    return text;
}

// Names the kinds of repair that there were. Empty if there were none.
std::string describe_repairs(const Repairs& repairs) {
    struct Kind {
        uint64_t count;
        const char *one, *many;
    };
    const Kind kinds[] = {{repairs.nearly_welded, "point welded nearby", "points welded nearby"},
                          {repairs.degenerate_triangles, "collapsed triangle", "collapsed triangles"},
                          {repairs.duplicate_triangles, "repeated triangle", "repeated triangles"},
                          {repairs.double_triangles, "double triangle", "double triangles"},
                          {repairs.slivers, "sliver", "slivers"},
                          {repairs.crowded_edges, "edge of more than two faces", "edges of more than two faces"},
                          {repairs.cut_edges, "edge cut open", "edges cut open"},
                          {repairs.split_points, "touching point", "touching points"},
                          {repairs.one_sided_cuts, "one-sided edge cut open", "one-sided edges cut open"},
                          {repairs.flipped_triangles, "triangle turned over", "triangles turned over"},
                          {repairs.inside_out, "component inside out", "components inside out"}};
    std::string text;
    for (const Kind& kind : kinds) {
        if (kind.count > 0)
            text += (text.empty() ? "" : ", ") + with_thousands(kind.count) + " " +
                    (kind.count == 1 ? kind.one : kind.many);
    }
    return text;
}

std::string describe_cost(const LayoutCost& cost) {
    return (cost.is_estimate ? "about " : "") + with_thousands(static_cast<uint64_t>(cost.bytes)) + " bytes, " +
           fixed(cost.psnr, 2) + " dB";
}

std::string summary(const EncodeCommand& command, const EncodeReport& report) {
    std::string text;
    const auto print_line = [&](const std::string& line) { text += line + "\n"; };
    print_line(format_line("file", shown_name(command.output, Direction::kWrite)));
    print_line(format_line("input vertices", with_thousands(report.input_vertices)));
    print_line(format_line("input triangles", with_thousands(report.input_triangles)));
    if (const std::string repairs = describe_repairs(report.repairs); !repairs.empty())
        print_line(format_line("repairs", repairs));
    if (report.topology.components > 1)
        print_line(format_line("components", with_thousands(report.topology.components)));
    if (report.hard_edges > 0) {
        print_line(format_line("hard edges", with_thousands(report.hard_edges) + " in the input, " +
                                                 with_thousands(report.hard_edges_kept) + " kept sharp"));
    }
    print_line(format_line("layout", name_of(report.layout)));
    for (const LayoutCost& cost : report.others)
        print_line(format_line(("  not " + std::string(name_of(cost.layout))).c_str(), describe_cost(cost)));
    print_line(
        format_line("image", std::to_string(report.width) + " x " + std::to_string(report.height) +
                                 (report.images > 1 ? ", the largest of " + std::to_string(report.images) : "")));
    if (report.charts > 0) {
        print_line(format_line("charts", std::to_string(report.charts) + ", " +
                                             fixed(100 * report.packing_efficiency, 1) + " % of the samples defined"));
    }
    if (report.border_samples > 0) {
        print_line(format_line("border samples", with_thousands(report.border_samples) + ", " +
                                                     with_thousands(report.open_samples) + " of them open"));
    }
    if (report.tiles > 0) {
        const std::string side = std::to_string(report.side);
        print_line(format_line("tiles", with_thousands(report.tiles) + " of " + side + " x " + side));
    }
    print_line(format_line("bytes", with_thousands(report.file_bytes)));
    for (const PlaneReport& plane : report.planes) {
        const bool is_color = plane.kind == PlaneReport::Kind::kColors;
        const std::string size = std::to_string(plane.width) + " x " + std::to_string(plane.height);
        print_line(
            format_line(is_color ? "colours" : "normal map",
                        size + ", " + with_thousands(plane.bytes) + " bytes, " +
                            (is_color ? fixed(plane.psnr, 1) + " dB" : fixed(plane.mean_angle, 2) + " degrees")));
    }
    print_line(format_line("bits per vertex", fixed(report.bits_per_vertex, 3)));
    print_line(format_line("bits per sample", fixed(report.bits_per_sample, 3)));
    print_line(format_line("PSNR", fixed(report.error.psnr, 2) + " dB"));
    const double share = report.error.diagonal > 0 ? 100 * report.error.hausdorff / report.error.diagonal : 0;
    print_line(format_line("largest error",
                           scientific(report.error.hausdorff) + ", " + scientific(share) + " % of the diagonal"));
    print_line(format_line("RMS input to decoded", scientific(report.error.rms_to_test)));
    print_line(format_line("RMS decoded to input", scientific(report.error.rms_to_reference)));
    const Defects& defects = *report.error.defects;
    print_line(format_line("folded over", describe_folds(defects)));
    if (defects.largest_fold.faces > 0) print_line(format_line("largest fold", describe_fold(defects.largest_fold)));
    for (const LevelReport& level : report.levels) {
        if (level.level == 0) continue;
        print_line(format_line(("  level " + std::to_string(level.level)).c_str(),
                               fixed(level.psnr, 2) + " dB, " + with_thousands(level.vertices) + " vertices, first " +
                                   with_thousands(level.prefix_bytes) + " bytes"));
    }
    for (const StageTime& time : report.times) {
        print_line(format_line(("  " + time.stage).c_str(), fixed(time.seconds, 2) + " s"));
    }
    print_line(format_line("all stages", fixed(report.seconds, 2) + " s"));
    return text;
}

// The summary goes where it mixes with no file: to stdout, or to stderr if a file goes to stdout.
FILE* summary_stream(const EncodeCommand& command) {
    if (command.quiet) return nullptr;
    if (is_standard_output(command.output)) return stderr;
    return !command.json.empty() && is_standard_output(command.json) ? nullptr : stdout;
}

// Writes file and report, and prints the summary. If any of that fails, no file is there.
int write_results(const EncodeCommand& command, Encoded encoded) {
    OutputFiles files;
    const auto stage = [&](const std::string& name, Bytes bytes) {
        const Result<void> staged = files.stage(name, std::move(bytes));
        return staged.ok() ? 0 : report_error(shown_name(name, Direction::kWrite), staged.error());
    };
    if (stage(command.output, std::move(encoded.bytes)) != 0) return 1;
    if (!command.json.empty()) {
        nlohmann::ordered_json document = {{"input", command.input}, {"output", command.output}};
        if (!command.refit.empty()) document["refit"] = command.refit;
        document.update(to_json(encoded.report));
        const std::string text = json_text(document);
        if (stage(command.json, {text.begin(), text.end()}) != 0) return 1;
    }
    if (FILE* const stream = summary_stream(command)) std::fputs(summary(command, encoded.report).c_str(), stream);
    if (const auto failure = results_failure()) return report_error(*failure);
    if (const auto failure = files.commit()) return report_error(*failure);
    return 0;
}

// Checks everything that can fail before minutes of work.
std::optional<FileError> check_names(const EncodeCommand& command) {
    const std::array<NamedFile, 4> files = {{{"MESH", command.input, Direction::kRead},
                                             {"--refit", command.refit, Direction::kRead},
                                             {"OUT", command.output, Direction::kWrite},
                                             {"--json", command.json, Direction::kWrite}}};
    if (auto failure = check_files(files)) return failure;
    if (detect_format({}, extension_of(command.output)) != MeshFormat::kUnknown) {
        return FileError{command.output,
                         {Stage::kWrite, "this is the name of a mesh, and OUT is a .gim file; did you leave OUT out?"}};
    }
    if (command.debug_folder.empty()) return {};
    const std::string strip = command.debug_folder + "/strip.png";
    if (is_companion(command.input, strip)) {
        return FileError{strip, {Stage::kWrite, "this file belongs to MESH; choose another --debug-dir"}};
    }
    for (const NamedFile& file : files) {
        if (file.name.empty() || !StatePictures(command.debug_folder).may_replace(file.name)) continue;
        return FileError{command.debug_folder,
                         {Stage::kWrite, "--debug-dir could replace " + file.role + "; choose another folder"}};
    }
    return {};
}

Result<void> check_raster_layout(const EncodeOptions& options) {
    if (options.layout == Layout::kMcgim || options.layout == Layout::kAuto) return {};
    return Error{Stage::kInput, "an image of charts has the layout mcgim; leave --layout out, or say mcgim"};
}

// Reads the mesh of --refit, if there is one, and encodes.
Result<Encoded> encode_by_command(const EncodeCommand& command, const Input& input, const Observer& observer) {
    if (command.refit.empty()) {
        ProgressPrinter printer(command.quiet);
        return encode_input(input, command.options, printer.callback(), observer);
    }
    const Result<TriangleMesh> mesh =
        read_surface_aloud(command.refit, 0, {.want = Want::kShape, .max_memory = command.max_memory});
    if (!mesh.ok())
        return Error{mesh.error().stage,
                     "--refit " + shown_name(command.refit, Direction::kRead) + ": " + mesh.error().message};
    ProgressPrinter printer(command.quiet);
    return refit_input(input, mesh.value(), command.options, printer.callback());
}

}  // namespace

Result<Encoded> refit_input(const Input& input, const TriangleMesh& mesh, const EncodeOptions& options,
                            const Progress& progress) {
    if (input.kind == Input::Kind::kRawImage) {
        return refit_image(input.raw.channels, input.raw.side, kRawWeldTolerance * diagonal_of(input.raw), mesh,
                           options, progress);
    }
    if (input.kind != Input::Kind::kRaster)
        return Error{Stage::kInput,
                     "--refit fits an image to a mesh (.npz, .exr, or a headerless .gim), and this is none"};
    if (auto layout = check_raster_layout(options); !layout.ok()) return layout.error();
    return refit_raster(input.raster, mesh, options, progress);
}

Result<Encoded> encode_input(const Input& input, const EncodeOptions& options, const Progress& progress,
                             const Observer& observer) {
    switch (input.kind) {
        case Input::Kind::kGim:
            return Error{Stage::kInput,
                         "this is already a .gim file; decode it (gim decode IN.gim OUT.ply) and encode the mesh"};
        case Input::Kind::kRawImage:
            return encode_image(input.raw.channels, input.raw.side, kRawWeldTolerance * diagonal_of(input.raw), options,
                                progress);
        case Input::Kind::kRaster:
            if (auto layout = check_raster_layout(options); !layout.ok()) return layout.error();
            return encode_raster(input.raster, options, progress);
        case Input::Kind::kMesh:
            break;
    }
    return encode(input.mesh, options, progress, observer);
}

int run_encode(const EncodeCommand& command) {
    if (extension_of(command.output) == "glb") {
        if (command.refit.empty()) return run_encode_glb(command);
        return report_error(shown_name(command.output, Direction::kWrite),
                            {Stage::kWrite, "--refit belongs to an image, which becomes a .gim file"});
    }
    if (command.fallback) {
        return report_error(shown_name(command.output, Direction::kWrite),
                            {Stage::kWrite, "--fallback belongs to a GLB; name OUT something.glb"});
    }
    if (const auto failure = check_names(command)) return report_error(*failure);

    const std::string input_name = shown_name(command.input, Direction::kRead);
    Result<Input> input =
        read_input(command.input, {Want::kShapeAndColors, command.max_memory, command.format, true, command.raster});
    if (!input.ok()) return report_error(input_name, input.error());
    print_warnings(input_name, input.value().warnings);

    StatePictures pictures(command.debug_folder);
    const bool draws = !command.debug_folder.empty();
    if (draws) {
        const Result<void> made = pictures.make_folder();
        if (!made.ok()) return report_error(command.debug_folder, made.error());
    }
    Result<Encoded> encoded = encode_by_command(command, input.value(), draws ? pictures.observer() : Observer());
    if (draws) {  // of a failed run too: there they are needed most
        const Result<void> drawn = pictures.finish();
        if (!drawn.ok()) return report_error(command.debug_folder, drawn.error());
    }
    if (!encoded.ok()) return report_error(input_name, encoded.error());
    print_warnings(input_name, encoded.value().report.warnings);
    return write_results(command, std::move(encoded.value()));
}

}  // namespace gim

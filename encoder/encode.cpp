// The driver from a triangle mesh to a .gim file. Its lines are the stages. layouts.h says who makes the images.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "encoder/base/guarded.h"
#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/check_options.h"
#include "encoder/choose_layout.h"
#include "encoder/code/rate_target.h"
#include "encoder/code_to_file.h"
#include "encoder/layouts.h"
#include "encoder/planes/input_colors.h"
#include "encoder/squares/best_side.h"
#include "encoder/surface/clean.h"
#include "encoder/surface/compare_meshes.h"
#include "encoder/surface/local_frame.h"
#include "encoder/within_budget.h"

namespace gim {

namespace {

void describe_input(const TriangleMesh& input, const CleanMesh& cleaned, EncodeReport& report) {
    report.input_vertices = input.positions.size();
    report.input_triangles = input.triangles.size();
    report.repairs = cleaned.report.repairs;
    report.warnings = cleaned.report.warnings;
    report.topology = cleaned.report.topology;
}

Result<Encoded> run_stages(const TriangleMesh& input, EncodeOptions options, const Progress& progress,
                           const Observer& observer) {
    StageClock clock(progress);
    GIM_CHECK(check_appearance(input));

    clock.begin(Stage::kClean);
    GIM_CHECK(check_extent(input, options.bits));
    const CleanOptions cleaning = {
        .require_connected = false, .strict = options.strict, .weld_tolerance = options.weld_tolerance};
    GIM_TRY(cleaned, clean(input, cleaning));
    EncodeReport input_report;
    describe_input(input, cleaned, input_report);

    // From here on, positions are in the frame.
    const LocalFrame frame = choose_frame(cleaned.mesh.positions, options.bits);
    move_into(frame, cleaned.mesh.positions);
    const std::optional<TriangleMesh> moved = moved_into(frame, input);
    const TriangleMesh& local_input = moved ? *moved : input;
    const Observer local_observer = moved_out_of(frame, observer);

    options.rate = resolved_target(options.rate, bounding_diagonal(cleaned.mesh));

    if (options.layout == Layout::kAuto) options.layout = choose_layout(cleaned.mesh, options, clock);
    const LayoutEntry* layout = find_layout(options.layout);
    if (layout == nullptr)
        return Error{Stage::kInput, "the encoder does not know this layout; take gim, mcgim or auto"};
    CutPreferences cuts;  // chosen at the first side, then kept
    const EncodeOnce make_and_code = [&](const EncodeOptions& now, const Contest& contest,
                                         const Observer& shown) -> Result<Encoded> {
        EncodeReport report = input_report;
        GIM_TRY(images, layout->make({cleaned.mesh, now, clock, shown, report, cuts}));
        return code_to_file(*images, {cleaned.mesh, local_input, frame}, now, contest, clock, std::move(report));
    };
    return within_budget(options, [&](const EncodeOptions& now) {
        cuts = {};
        const bool is_first = now.rate.value == options.rate.value;
        return best_of_sides(make_and_code, now, clock, is_first ? local_observer : Observer());
    });
}

}  // namespace

Result<Encoded> encode(const TriangleMesh& mesh, const EncodeOptions& given, const Progress& progress,
                       const Observer& observer) {
    GIM_CHECK(check_options(given));
    EncodeOptions options = given;
    options.node_side = std::min(options.node_side, options.side);  // an image cannot be finer than itself
    return guarded(options.threads, [&] { return run_stages(mesh, options, progress, observer); });
}

}  // namespace gim

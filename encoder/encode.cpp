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
#include "encoder/layout_runs.h"
#include "encoder/layouts.h"
#include "encoder/planes/input_colors.h"
#include "encoder/planes/labels.h"
#include "encoder/race_layouts.h"
#include "encoder/surface/authored_edges.h"
#include "encoder/surface/clean.h"
#include "encoder/surface/compare_meshes.h"
#include "encoder/surface/local_frame.h"

namespace gim {

namespace {

void describe_input(const TriangleMesh& input, const CleanMesh& cleaned, EncodeReport& report) {
    report.input_vertices = input.positions.size();
    report.input_triangles = input.triangles.size();
    report.repairs = cleaned.report.repairs;
    report.warnings = cleaned.report.warnings;
    report.topology = cleaned.report.topology;
}

// The layout that suits the surface, or the next one that can make images of it.
Result<Encoded> encode_losslessly(const Prepared& prepared, const EncodeOptions& options, StageClock& clock,
                                  const Observer& observer) {
    const Layout preferred = choose_layout(prepared.mesh, options, clock);
    auto encoded = LayoutRuns(*find_layout(preferred), prepared, options, clock, observer).best({});
    for (const LayoutEntry& other : all_layouts()) {
        if (!lacks_images(encoded) || other.layout == preferred) continue;
        auto again = LayoutRuns(other, prepared, options, clock, observer).best({});
        if (again.ok()) return again;
    }
    return encoded;
}

Result<Encoded> encode_by(Layout layout, const Prepared& prepared, const EncodeOptions& options, StageClock& clock,
                          const Observer& observer) {
    if (layout == Layout::kAuto) {
        return options.rate.kind == RateTarget::Kind::kLossless ? encode_losslessly(prepared, options, clock, observer)
                                                                : race_layouts(prepared, options, clock, observer);
    }
    const LayoutEntry* entry = find_layout(layout);
    if (entry == nullptr)
        return Error{Stage::kInput, "the encoder does not know this layout; take gim, mcgim, tiles or auto"};
    return LayoutRuns(*entry, prepared, options, clock, observer).best({});
}

Result<Encoded> run_stages(const TriangleMesh& input, EncodeOptions options, const Progress& progress,
                           const Observer& observer) {
    StageClock clock(progress);
    GIM_CHECK(check_appearance(input));
    GIM_CHECK(check_labels(input, options.layout));

    clock.begin(Stage::kClean);
    GIM_CHECK(check_extent(input, options.bits));
    const CleanOptions cleaning = {
        .require_connected = false, .strict = options.strict, .weld_tolerance = options.weld_tolerance};
    GIM_TRY(cleaned, clean(input, cleaning));
    EncodeReport input_report;
    describe_input(input, cleaned, input_report);

    const LocalFrame frame = choose_frame(cleaned.mesh.positions, options.bits);
    move_into(frame, cleaned.mesh.positions);
    const std::optional<TriangleMesh> moved = moved_into(frame, input);
    const ReferenceSurface reference(cleaned.mesh, options.threads);
    const AuthoredEdges authored = read_authored_edges(reference.mesh(), cleaned.breaks);
    input_report.hard_edges = authored.named;
    const Prepared prepared{reference.mesh(), {reference, moved ? *moved : input, frame}, input_report, authored};
    const Observer local_observer = moved_out_of(frame, observer);

    options.rate = resolved_target(options.rate, reference.diagonal());
    return timed(encode_by(options.layout, prepared, options, clock, local_observer), clock);
}

// Labels come to a finished file. So they take their bytes from a budget in another run.
Result<Encoded> run_within_budget(const TriangleMesh& input, const EncodeOptions& options, const Progress& progress,
                                  const Observer& observer) {
    EncodeOptions now = options;
    auto encoded = run_stages(input, now, progress, observer);
    if (options.rate.kind != RateTarget::Kind::kBytes || !has_labels(input)) return encoded;
    constexpr int kMostRuns = 4;
    for (int run = 1; encoded.ok() && double(encoded.value().bytes.size()) > options.rate.value; ++run) {
        const double excess = double(encoded.value().bytes.size()) - options.rate.value;
        if (run == kMostRuns || now.rate.value <= excess) {
            return Error{Stage::kCode, "the labels leave too few bytes for the surface; allow " +
                                           std::to_string(static_cast<uint64_t>(excess)) + " more"};
        }
        now.rate.value -= excess;
        encoded = run_stages(input, now, progress, {});
    }
    return encoded;
}

}  // namespace

Result<Encoded> encode(const TriangleMesh& mesh, const EncodeOptions& given, const Progress& progress,
                       const Observer& observer) {
    GIM_CHECK(check_options(given));
    EncodeOptions options = given;
    options.node_side = std::min(options.node_side, options.side);  // an image cannot be finer than itself
    return guarded(options.threads, [&] { return run_within_budget(mesh, options, progress, observer); });
}

}  // namespace gim

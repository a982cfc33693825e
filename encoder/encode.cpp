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
#include "encoder/tiles/best_tiles.h"
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

// The input, ready for a layout. Positions are in the frame.
struct Prepared {
    const Mesh& mesh;  // clean
    const TriangleMesh& input;
    const LocalFrame& frame;
    const EncodeReport& report;  // of the input alone
};

Result<Encoded> encode_as(const LayoutEntry& layout, const Prepared& prepared, EncodeOptions options, StageClock& clock,
                          const Observer& observer) {
    options.layout = layout.layout;
    const bool drops_colors = layout.layout == Layout::kTiles && !options.color_side;
    if (drops_colors) options.color_side = 0;
    CutPreferences cuts;        // chosen at the first side, then kept
    TileableSurfaces tileable;  // serve every number of tiles
    const EncodeOnce make_and_code = [&](const EncodeOptions& now, const Contest& contest,
                                         const Observer& shown) -> Result<Encoded> {
        EncodeReport report = prepared.report;
        if (drops_colors && !prepared.input.appearance.empty())
            report.warnings.push_back("tiles hold no colours; those of the input are left out");
        const bool may_grow = now.side == options.side;  // smaller sides are trials
        GIM_TRY(images, layout.make({prepared.mesh, now, clock, shown, report, cuts, tileable, may_grow}));
        return code_to_file(*images, {prepared.mesh, prepared.input, prepared.frame}, now, contest, clock,
                            std::move(report));
    };
    return within_budget(options, [&](const EncodeOptions& now) {
        cuts = {};
        const bool is_first = now.rate.value == options.rate.value;
        const Observer shown = is_first ? observer : Observer();
        return layout.layout == Layout::kTiles ? best_of_tiles(make_and_code, now, clock, shown, tileable)
                                               : best_of_sides(make_and_code, now, clock, shown);
    });
}

// Returns whether the images could not be made.
bool lacks_images(const Result<Encoded>& encoded) {
    return !encoded.ok() && encoded.error().stage >= Stage::kCut && encoded.error().stage <= Stage::kFit;
}

// Takes another layout if the one that suits the surface cannot make images of it.
Result<Encoded> encode_as_any(const Prepared& prepared, const EncodeOptions& options, StageClock& clock,
                              const Observer& observer) {
    const Layout preferred = choose_layout(prepared.mesh, options, clock);
    auto encoded = encode_as(*find_layout(preferred), prepared, options, clock, observer);
    for (const LayoutEntry& other : all_layouts()) {
        if (!lacks_images(encoded) || other.layout == preferred) continue;
        auto again = encode_as(other, prepared, options, clock, observer);
        if (again.ok()) return again;
    }
    return encoded;
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

    const LocalFrame frame = choose_frame(cleaned.mesh.positions, options.bits);
    move_into(frame, cleaned.mesh.positions);
    const std::optional<TriangleMesh> moved = moved_into(frame, input);
    const Prepared prepared{cleaned.mesh, moved ? *moved : input, frame, input_report};
    const Observer local_observer = moved_out_of(frame, observer);

    options.rate = resolved_target(options.rate, bounding_diagonal(cleaned.mesh));
    if (options.layout == Layout::kAuto) return encode_as_any(prepared, options, clock, local_observer);
    const LayoutEntry* layout = find_layout(options.layout);
    if (layout == nullptr)
        return Error{Stage::kInput, "the encoder does not know this layout; take gim, mcgim, tiles or auto"};
    return encode_as(*layout, prepared, options, clock, local_observer);
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

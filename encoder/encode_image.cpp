// The driver from an existing geometry image to a .gim file.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "encoder/base/guarded.h"
#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/check_options.h"
#include "encoder/clean_target.h"
#include "encoder/code/rate_target.h"
#include "encoder/file_run.h"
#include "encoder/fit/fit_strength.h"
#include "encoder/fit/measure_start.h"
#include "encoder/squares/import_image.h"
#include "encoder/squares/square_fit.h"
#include "encoder/squares/squares_layout.h"
#include "encoder/surface/compare_meshes.h"
#include "encoder/surface/local_frame.h"
#include "encoder/within_budget.h"
#include "gim/refit.h"

namespace gim {
namespace {

std::string sample_name(const SquareImage& image, size_t i) {
    return "the sample at row " + std::to_string(i / image.side()) + ", column " + std::to_string(i % image.side());
}

// As make_square() fits the squares of a mesh.
Result<void> fit_to(const Mesh& surface, const EncodeOptions& options, SquareImage& image, StageClock& clock,
                    EncodeReport& report) {
    clock.begin(Stage::kFit);
    GIM_CHECK(measure_start(image, surface, options.threads));
    const std::optional<FitOptions> fit_options = first_fit(options);
    if (!fit_options || !needs_first_fit(options, image.side())) return {};
    GIM_TRY(fitted, fit(image, surface, *fit_options, clock.progress()));
    image.positions = std::move(fitted.positions);
    report.folds_before_fit = fitted.before.folds;
    return {};
}

// mesh: null, or what the samples are fitted to. Without it, the image's own surface is the reference.
Result<Encoded> run_stages(const std::vector<float>& channels, uint32_t side, double weld_tolerance,
                           const TriangleMesh* mesh, EncodeOptions options, const Progress& progress) {
    StageClock clock(progress);
    clock.begin(Stage::kInput);
    GIM_TRY(image, import_image(channels, side, weld_tolerance));
    GIM_CHECK(
        check_extent(image.positions, options.bits, Stage::kInput, [&](size_t i) { return sample_name(image, i); }));
    const LocalFrame frame = choose_frame(image.positions, options.bits);
    move_into(frame, image.positions);

    EncodeReport report;
    Mesh surface;
    if (mesh != nullptr) {
        clock.begin(Stage::kClean);
        GIM_TRY(target, clean_target(*mesh, options, report));
        surface = std::move(target);
        move_into(frame, surface.positions);
        GIM_CHECK(fit_to(surface, options, image, clock, report));
    } else {
        surface = samples_as_mesh(image);
        report.input_vertices = image.positions.size();
        report.input_triangles = surface.triangles.size();
    }
    options.rate = resolved_target(options.rate, bounding_diagonal(surface));

    // Levels coarser than the node grid cannot be closed, so they are not stored separately.
    options.side = image.side();
    options.node_side =
        std::clamp(std::max(options.node_side, image.sideband.node_side), 5u, std::max(image.side(), 5u));
    const ReferenceSurface reference(surface, options.threads);
    const TriangleMesh no_colors;
    auto encoded = within_budget(options, [&](const EncodeOptions& now) {
        Squares squares;
        squares.images.push_back(image);
        squares.surfaces.push_back(surface);
        FileRun run(squares_layout(std::move(squares), now), {reference, no_colors, frame}, now, clock, report);
        return run.finish({});
    });
    return timed(std::move(encoded), clock);
}

Result<Encoded> encode(const std::vector<float>& channels, uint32_t side, double weld_tolerance,
                       const TriangleMesh* mesh, const EncodeOptions& options, const Progress& progress) {
    EncodeOptions checked_options = options;
    checked_options.side = 257;  // the image has its own side
    checked_options.node_side = 17;
    GIM_CHECK(check_options(checked_options));
    return guarded(options.threads,
                   [&] { return run_stages(channels, side, weld_tolerance, mesh, options, progress); });
}

}  // namespace

Result<Encoded> encode_image(const std::vector<float>& channels, uint32_t side, double weld_tolerance,
                             const EncodeOptions& options, const Progress& progress) {
    return encode(channels, side, weld_tolerance, nullptr, options, progress);
}

Result<Encoded> refit_image(const std::vector<float>& channels, uint32_t side, double weld_tolerance,
                            const TriangleMesh& mesh, const EncodeOptions& options, const Progress& progress) {
    return encode(channels, side, weld_tolerance, &mesh, options, progress);
}

}  // namespace gim

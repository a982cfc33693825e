#include "encoder/single_chart.h"

#include "encoder/augment_cut.h"
#include "encoder/boundary_map.h"
#include "encoder/density.h"
#include "encoder/fit.h"
#include "encoder/parametrize.h"
#include "encoder/refine.h"
#include "encoder/result.h"
#include "encoder/sample.h"
#include "encoder/stretch.h"

namespace gim {

namespace {

// Faces larger than this part of the surface are split before cutting: about 8 samples of a 257 x 257 image.
constexpr double kLargestFace = 1.0 / 8000;

// A loose fit multiplies the tangential detail: only what is coded without loss can afford it.
bool is_loose(const EncodeOptions& options) {
    if (options.fit != FitStrength::kAuto) return options.fit == FitStrength::kLoose;
    return options.rate.kind == RateTarget::Kind::kLossless;
}

}  // namespace

Result<SingleChart> make_geometry_image(const Mesh& mesh, const EncodeOptions& options, StageClock& clock) {
    SingleChart chart;
    const BoundaryMapOptions square{options.side, options.node_side};

    clock.begin(Stage::kCut);
    const Mesh fine = refine_large_faces(mesh, kLargestFace * surface_area(mesh));
    const Topology topology = build_topology(fine);
    AugmentOptions search;
    search.boundary = square;
    GIM_TRY(found, find_cut(fine, topology, search, clock.progress()));
    chart.cut_length = cut_length(fine, topology, found.cut);
    GIM_TRY(opened, open_mesh(fine, topology, found.cut));

    clock.begin(Stage::kBoundaryMap);
    GIM_TRY(boundary, map_boundary(std::move(opened), square));

    clock.begin(Stage::kParametrize);
    const Mesh& disk = boundary.opened.mesh;
    const std::vector<Vec2> border = boundary_uv(boundary, options.side);
    GIM_TRY(even, parametrize(disk, boundary.sides, border, {}, clock.progress()));
    std::vector<Vec2> uv = std::move(even);
    chart.stretch_efficiency = stretch_efficiency(disk, uv, 1.0);
    if (options.density) {
        ParametrizeOptions weighted;
        weighted.importance = importance_from_error(disk, uv, sample_surface(boundary, uv, options.side), {});
        GIM_TRY(adapted, parametrize(disk, boundary.sides, border, weighted, clock.progress()));
        uv = std::move(adapted);
    }
    chart.flipped_triangles = count_flipped(disk, uv);

    clock.begin(Stage::kSample);
    chart.image = sample_surface(boundary, uv, options.side);
    if (options.fit == FitStrength::kOff) return chart;

    clock.begin(Stage::kFit);
    FitOptions fit_options;
    fit_options.strength = is_loose(options) ? FitOptions::Strength::kLoose : FitOptions::Strength::kStiff;
    fit_options.seed = options.seed;
    fit_options.threads = options.threads;
    GIM_TRY(fitted, fit(chart.image, mesh, fit_options, clock.progress()));
    chart.image = std::move(fitted.image);
    chart.folds = fitted.after.folds;
    chart.folds_before_fit = fitted.before.folds;
    return chart;
}

}  // namespace gim

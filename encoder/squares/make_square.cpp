#include "encoder/squares/make_square.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "encoder/base/result.h"
#include "encoder/fit/fit_strength.h"
#include "encoder/image/density.h"
#include "encoder/image/snapshot.h"
#include "encoder/squares/augment_cut.h"
#include "encoder/squares/boundary_map.h"
#include "encoder/squares/circle_map.h"
#include "encoder/squares/parametrize.h"
#include "encoder/squares/sample_square.h"
#include "encoder/squares/square_fit.h"
#include "encoder/surface/coarsened.h"
#include "encoder/surface/refine.h"
#include "encoder/surface/stretch.h"

namespace gim {

namespace {

// Faces larger than this part of the surface are split before cutting. It is about 8 samples of the image, within
// bounds: with too few faces the cut has no choice, and too many cost more time than they are worth. In tiny
// images, faces of half a cell or less stay whole.
double largest_face(uint32_t side) {
    const double samples = double(side) * side, cells = double(side - 1) * (side - 1);
    return std::clamp(8 / samples, 1.0 / 8000, std::max(1.0 / 1000, 0.5 / cells));
}

// Denser surfaces are coarsened before they are cut. With 0.4, cut and map take less time still, but long limbs fold more.
constexpr double kVerticesPerSample = 3;
constexpr double kFewVertices = 50000;  // cost little

std::string percent(double part) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f%%", 100 * part);
    return text;
}

Snapshot show_map(std::string name, std::string caption, const OpenedMesh& opened, const std::vector<Vec2>& uv) {
    return make_snapshot(std::move(name), std::move(caption), opened.mesh, edges_of_loop(opened.loop), uv);
}

// Shows the search for the cut, state by state.
void show_cut_search(const FoundCut& found, const Observer& observer) {
    const Topology topology = build_topology(found.searched);
    uint32_t number = 0;
    for (size_t i = 0; i < found.steps.size(); ++i) {
        const AugmentStep& step = found.steps[i];
        if (i + 1 < found.steps.size() && found.steps[i + 1].cut == step.cut) continue;  // the next step only judges it
        const auto opened = open_mesh(found.searched, topology, step.cut);
        if (!opened.ok()) continue;
        char name[32];
        std::snprintf(name, sizeof name, "cut-%02u", number++);
        const std::string reached = step.efficiency > 0 ? "stretch efficiency " + percent(step.efficiency) : "start";
        observer(show_map(name, reached, opened.value(), circle_map(opened.value())));
    }
}

}  // namespace

CuttableSurface make_cuttable(const Mesh& mesh, const EncodeOptions& options) {
    const double most = std::max(kFewVertices, kVerticesPerSample * options.side * options.side);
    Mesh coarsened = is_fitted_to_codec(options) ? coarsened_to(mesh, most) : mesh;
    const double largest = largest_face(options.side) * surface_area(coarsened);
    Mesh fine = refine_large_faces(std::move(coarsened), largest);
    Topology topology = build_topology(fine);
    CoarseSurface coarse = coarsen(fine, kSearchVertices);
    return {std::move(fine), std::move(topology), std::move(coarse)};
}

Result<CutSurface> cut_open(const CuttableSurface& surface, const EncodeOptions& options,
                            const CutPreference& preference, const Progress& progress, const Observer& observer) {
    AugmentOptions search;
    search.boundary = {options.side, options.node_side, preference.most_excess, preference.least_units};
    search.path_cost = preference.path_cost;
    GIM_TRY(found, find_cut(surface.mesh, surface.topology, surface.coarse, search, progress));
    GIM_TRY(opened, open_mesh(surface.mesh, surface.topology, found.cut));
    if (observer) show_cut_search(found, observer);
    GIM_TRY(boundary, map_boundary(std::move(opened), search.boundary));
    return CutSurface{std::move(boundary), cut_length(surface.mesh, surface.topology, found.cut)};
}

Result<MadeSquare> map_and_sample(const CutSurface& cut, const Mesh& mesh, const EncodeOptions& options,
                                  StageClock& clock, const Observer& observer) {
    MadeSquare square;
    square.cut_length = cut.cut_length;

    clock.begin(Stage::kParametrize);
    const Mesh& disk = cut.boundary.opened.mesh;
    const bool lossless = options.rate.kind == RateTarget::Kind::kLossless;
    ParametrizeOptions weighted;
    weighted.squeeze = lossless ? kLosslessSqueeze : kCodedSqueeze;
    const DiskMapper mapper(disk, cut.boundary.sides, boundary_uv(cut.boundary, options.side));
    GIM_TRY(even, mapper.map(weighted, clock.progress()));
    std::vector<Vec2> uv = std::move(even);
    square.stretch_efficiency = stretch_efficiency(disk, uv, 1.0);
    if (observer) {
        observer(show_map("map-even", "least stretch, " + percent(square.stretch_efficiency), cut.boundary.opened, uv));
    }
    if (options.density) {
        GIM_TRY(first, sample_surface(cut.boundary, uv, options.side));
        weighted.importance = importance_from_error(disk, uv, first, lossless ? DensityOptions{} : kCodedDensity);
        GIM_TRY(adapted, mapper.map(weighted, clock.progress()));
        uv = std::move(adapted);
        if (observer) observer(show_map("map-density", "denser where it errs", cut.boundary.opened, uv));
    }
    square.flipped_triangles = count_flipped(disk, uv);

    clock.begin(Stage::kSample);
    GIM_TRY(sampled, sample_surface(cut.boundary, uv, options.side));
    square.image = std::move(sampled);
    if (observer) observer(make_snapshot("image-sampled", "sampled", square.image));
    const std::optional<FitOptions> fit_options = first_fit(options);
    if (!fit_options || !needs_first_fit(options, options.side)) return square;

    clock.begin(Stage::kFit);
    GIM_TRY(fitted, fit(square.image, mesh, *fit_options, clock.progress()));
    square.image.positions = std::move(fitted.positions);
    square.folds_before_fit = fitted.before.folds;
    if (observer) observer(make_snapshot("image-fitted", "fitted", square.image));
    return square;
}

Result<MadeSquare> make_square(const Mesh& mesh, const EncodeOptions& options, const CutPreference& preference,
                               StageClock& clock, const Observer& observer) {
    clock.begin(Stage::kCut);
    GIM_TRY(cut, cut_open(make_cuttable(mesh, options), options, preference, clock.progress(), observer));
    return map_and_sample(cut, mesh, options, clock, observer);
}

}  // namespace gim

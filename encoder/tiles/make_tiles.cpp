#include "encoder/tiles/make_tiles.h"

#include <string>
#include <utility>
#include <vector>

#include "encoder/fit/fit.h"
#include "encoder/fit/fit_strength.h"
#include "encoder/image/density.h"
#include "encoder/surface/closest_point.h"
#include "encoder/surface/stretch.h"
#include "encoder/tiles/locate_samples.h"
#include "encoder/tiles/sample_tiles.h"
#include "encoder/tiles/split_chords.h"
#include "encoder/tiles/tile_base.h"
#include "encoder/tiles/tile_map.h"
#include "format/tile_atlas.h"

namespace gim {

namespace {

// What squeezing the surface costs in the map (tile_map.h).
constexpr double kCodedSqueeze = 1, kLosslessSqueeze = 0.2;

// The finest tiles whose atlas has at most so many samples; at least 2 x 2 intervals.
uint32_t exponent_within(uint32_t tiles, uint64_t samples) {
    uint32_t exponent = 1;
    while (exponent < kMostTileExponent && TileAtlas(tiles, 2u << exponent).samples() <= samples) ++exponent;
    return exponent;
}

struct TiledSurface {
    TileInput input;
    TileBase base;
};

Result<TiledSurface> find_base(const Mesh& mesh, uint32_t tiles) {
    TiledSurface made;
    made.input = make_room_for_tiles(mesh, {});
    split_chords(made.input.mesh, made.input.sharp);
    const BaseHierarchy hierarchy(made.input.mesh, made.input.sharp);
    made.base = make_tile_base(made.input, hierarchy, 2 * tiles);
    if (!made.base.pairing.unpaired.empty()) {
        return Error{Stage::kCut, std::to_string(made.base.pairing.unpaired.size()) +
                                      " triangles of the base mesh do not pair into tiles; take another layout"};
    }
    return made;
}

struct Sampled {
    TileImage tiles;
    GeometryImage atlas;
};
Result<Sampled> sample(const Mesh& dense, const TileMap& map, uint32_t exponent) {
    GIM_TRY(points, locate_samples(map, 1u << exponent));
    Sampled sampled{sample_tiles(dense.positions, map, points, exponent), {}};
    GIM_TRY(atlas, atlas_of(sampled.tiles));
    sampled.atlas = std::move(atlas);
    return sampled;
}

VertexAreas areas_of(const Mesh& dense, const TileMap& map) {
    const size_t count = dense.positions.size();
    VertexAreas areas{std::vector<double>(count, 0.0), std::vector<double>(count, 0.0)};
    for (size_t f = 0; f < map.triangles.size(); ++f) {
        const auto& at = map.placed[f].corners;
        const double square = twice_signed_area(at[0], at[1], at[2]);
        for (const uint32_t v : map.triangles[f]) areas.square[v] += square;
    }
    for (uint32_t f = 0; f < dense.triangles.size(); ++f) {
        for (const uint32_t v : dense.triangles[f]) areas.surface[v] += 2 * face_area(dense, f);
    }
    return areas;
}

// How much each vertex of the mesh should count, from the error that a first sampling leaves.
std::vector<double> importance_from(const Mesh& dense, const TileMap& map, const GeometryImage& atlas, bool lossless) {
    const auto closest = ClosestPointTree(surface_of(atlas).mesh).find_all(dense.positions);
    return importance_of(dense, areas_of(dense, map), closest, lossless ? DensityOptions{} : kCodedDensity);
}

}  // namespace

Result<MadeTiles> make_tiles(const Mesh& mesh, const EncodeOptions& options, StageClock& clock, const Observer&) {
    clock.begin(Stage::kCut);
    GIM_TRY(surface, find_base(mesh, options.tiles));
    const Mesh& dense = surface.input.mesh;

    clock.begin(Stage::kParametrize);
    const bool lossless = options.rate.kind == RateTarget::Kind::kLossless;
    TileMapOptions map_options;
    map_options.squeeze = lossless ? kLosslessSqueeze : kCodedSqueeze;
    GIM_TRY(map, map_tiles(dense, surface.base.base, surface.base.pairing.quads, map_options, clock.progress()));
    MadeTiles made;
    made.stretch_efficiency = stretch_efficiency(dense.positions, map);

    const uint32_t exponent = exponent_within(static_cast<uint32_t>(map.quads.size()), options.samples);
    if (options.density) {
        GIM_TRY(first, sample(dense, map, exponent));
        map_options.importance = importance_from(dense, map, first.atlas, lossless);
        GIM_TRY(adapted,
                map_tiles(dense, surface.base.base, surface.base.pairing.quads, map_options, clock.progress()));
        map = std::move(adapted);
    }

    clock.begin(Stage::kSample);
    GIM_TRY(sampled, sample(dense, map, exponent));
    made.tiles = std::move(sampled.tiles);
    made.atlas = std::move(sampled.atlas);
    const auto strength = fit_strength(options);
    if (!strength) return made;

    clock.begin(Stage::kFit);
    FitOptions fit_options;
    fit_options.strength = *strength;
    fit_options.seed = options.seed;
    fit_options.threads = options.threads;
    GIM_TRY(fitted, fit(made.atlas, mesh, fit_options, clock.progress()));
    made.folds_before_fit = fitted.before.folds;
    made.atlas.positions = std::move(fitted.positions);
    return made;
}

}  // namespace gim

#include "encoder/tiles/make_tiles.h"

#include <string>
#include <utility>
#include <vector>

#include "encoder/fit/fit.h"
#include "encoder/fit/fit_strength.h"
#include "encoder/tiles/locate_samples.h"
#include "encoder/tiles/sample_tiles.h"
#include "encoder/tiles/tile_base.h"
#include "encoder/tiles/tile_map.h"
#include "format/tile_atlas.h"

namespace gim {

namespace {

// What squeezing the surface costs in the map (tile_map.h).
constexpr double kCodedSqueeze = 1, kLosslessSqueeze = 0.2;
constexpr uint32_t kUsualTiles = 120;

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
    const BaseHierarchy hierarchy(made.input.mesh, made.input.sharp);
    made.base = make_tile_base(made.input, hierarchy, 2 * tiles);
    if (!made.base.pairing.unpaired.empty()) {
        return Error{Stage::kCut, std::to_string(made.base.pairing.unpaired.size()) +
                                      " triangles of the base mesh do not pair into tiles; take another layout"};
    }
    return made;
}

}  // namespace

Result<MadeTiles> make_tiles(const Mesh& mesh, const EncodeOptions& options, StageClock& clock, const Observer&) {
    clock.begin(Stage::kCut);
    GIM_TRY(surface, find_base(mesh, options.tiles > 0 ? options.tiles : kUsualTiles));
    const Mesh& dense = surface.input.mesh;

    clock.begin(Stage::kParametrize);
    const bool lossless = options.rate.kind == RateTarget::Kind::kLossless;
    TileMapOptions map_options;
    map_options.squeeze = lossless ? kLosslessSqueeze : kCodedSqueeze;
    GIM_TRY(map, map_tiles(dense, surface.base.base, surface.base.pairing.quads, map_options, clock.progress()));
    MadeTiles made;
    made.stretch_efficiency = stretch_efficiency(dense.positions, map);

    clock.begin(Stage::kSample);
    const uint32_t exponent = exponent_within(static_cast<uint32_t>(map.quads.size()), options.samples);
    GIM_TRY(points, locate_samples(map, 1u << exponent));
    made.tiles = sample_tiles(dense.positions, map, points, exponent);
    GIM_TRY(atlas, atlas_of(made.tiles));
    made.atlas = std::move(atlas);
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

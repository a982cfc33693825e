#include "encoder/tiles/make_tiles.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "encoder/fit/fit.h"
#include "encoder/fit/fit_strength.h"
#include "encoder/image/density.h"
#include "encoder/surface/closest_point.h"
#include "encoder/surface/stretch.h"
#include "encoder/tiles/code_complex.h"
#include "encoder/tiles/crease_rails.h"
#include "encoder/tiles/locate_samples.h"
#include "encoder/tiles/sample_tiles.h"
#include "encoder/tiles/split_chords.h"
#include "encoder/tiles/tile_map.h"
#include "format/tile_atlas.h"

namespace gim {

namespace {

// The finest tiles whose atlas has at most so many samples; at least 2 x 2 intervals.
uint32_t exponent_within(uint32_t tiles, uint64_t samples) {
    uint32_t exponent = 1;
    while (exponent < kMostTileExponent && TileAtlas(tiles, 2u << exponent).samples() <= samples) ++exponent;
    return exponent;
}

// Sweeps of a map that only tells where a first sampling leaves error.
constexpr int kDraftSweeps = 4, kFinalDraftSweeps = 10;

// The map that comes first.
TileMapOptions first_map(const TileMapOptions& last, bool is_draft) {
    TileMapOptions options = last;
    if (is_draft) options.sweeps = kDraftSweeps, options.final_sweeps = kFinalDraftSweeps;
    return options;
}

// A base of about so many tiles. If it has so many more that they must be coarser to stay within the samples, a base of a
// few less.
TileBase base_within(const TileableSurface& surface, size_t tiles, uint64_t samples) {
    const auto base_of = [&](size_t wanted) {
        return make_tile_base(surface.input, surface.hierarchy, static_cast<uint32_t>(2 * wanted));
    };
    const uint32_t least = exponent_within(static_cast<uint32_t>(tiles), samples);
    const auto stays_within = [&](const TileBase& base) {
        return exponent_within(static_cast<uint32_t>(base.pairing.quads.size()), samples) >= least;
    };
    TileBase first = base_of(tiles);
    if (stays_within(first)) return first;
    const size_t fewest = tiles - tiles / 4, step = tiles / 24 + 1;
    for (size_t fewer = tiles; fewer >= fewest + step;) {
        TileBase base = base_of(fewer -= step);
        if (stays_within(base)) return base;
    }
    return first;
}

struct MappedBase {
    TileBase tiles;
    TileMap map;
};

// Vertices that the map may leave out, one of so many. A vertex without a place takes those with it that came from it, so
// a base that is too coarse for its handles loses most of them, and others hardly any.
constexpr size_t kLeftOutOf = 1000;
// Bases of which the map is tried. Each has a quarter more tiles than the one before.
constexpr int kMostMaps = 8;

// Makes a base of about so many tiles, or a larger one if that does not pair or leaves too many vertices out.
Result<MappedBase> find_base(const TileableSurface& surface, uint32_t tiles, uint64_t samples,
                             const TileMapOptions& options, StageClock& clock) {
    const Mesh& dense = surface.input.mesh;
    std::optional<MappedBase> best;
    int maps = 0;
    for (size_t wanted = tiles; maps < kMostMaps; wanted += wanted / 4 + 1) {
        clock.begin(Stage::kCut);
        TileBase base = base_within(surface, wanted, samples);
        const bool finest = base.base.triangles.size() == dense.triangles.size();
        wanted = std::max(wanted, base.base.triangles.size() / 2);
        if (base.pairing.unpaired.empty()) {
            clock.begin(Stage::kParametrize);
            GIM_TRY(map, map_tiles(dense, base.base, base.pairing.quads, options, clock.progress()));
            ++maps;
            if (!best || map.left_out.size() < best->map.left_out.size()) best = {std::move(base), std::move(map)};
            if (best->map.left_out.size() <= dense.positions.size() / kLeftOutOf) break;
        }
        if (finest) break;
    }
    if (best) return std::move(*best);
    return Error{Stage::kCut, "no base mesh of this surface pairs into tiles; take another layout"};
}

struct Sampled {
    TileImage tiles;
    GeometryImage atlas;
    Rails rails;  // of the atlas
};

// The same rails for the samples of the atlas.
Result<Rails> rails_of_atlas(const TileImage& tiles, Rails rails) {
    if (rails.of_sample.empty()) return rails;
    GIM_TRY(sample_at, samples_of_atlas(tiles));
    const std::vector<uint32_t> curve_of = std::move(rails.of_sample);
    rails.of_sample.clear();
    for (const uint32_t s : sample_at) rails.of_sample.push_back(s == kNone ? kNone : curve_of[s]);
    return rails;
}

Result<Sampled> sample(const TileInput& input, const TileMap& map, uint32_t exponent) {
    const uint32_t side = 1u << exponent;
    GIM_TRY(points, locate_samples(map, side));
    Sampled sampled{sample_tiles(input.mesh.positions, map, points, exponent), {}, {}};
    TileImage& tiles = sampled.tiles;
    GIM_TRY(complex, complex_of(tiles.quads, tiles.vertices));
    CreaseRails creases = crease_rails(input.mesh, input.sharp, map, points, complex.view(), side);
    tiles.is_sharp = std::find(creases.half_edge.begin(), creases.half_edge.end(), true) != creases.half_edge.end();
    if (tiles.is_sharp) tiles.sharp = std::move(creases.half_edge);
    GIM_TRY(atlas, atlas_of(tiles));
    GIM_TRY(rails, rails_of_atlas(tiles, std::move(creases.rails)));
    sampled.atlas = std::move(atlas);
    sampled.rails = std::move(rails);
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

TileableSurface make_tileable(const Mesh& mesh, const std::vector<bool>& creases) {
    TileInput input = make_room_for_tiles(mesh, creases);
    split_chords(input.mesh, input.sharp);
    BaseHierarchy hierarchy(input.mesh, input.sharp);
    return {std::move(input), std::move(hierarchy)};
}

const std::vector<bool>& TileableSurfaces::creases() {
    if (!creases_) creases_ = creases_of(mesh_, authored_);
    return *creases_;
}

bool TileableSurfaces::has_creases() { return std::find(creases().begin(), creases().end(), true) != creases().end(); }

const TileableSurface& TileableSurfaces::of(bool with_creases) {
    const bool creased = with_creases && has_creases();
    std::optional<TileableSurface>& surface = creased ? creased_ : smooth_;
    if (!surface) surface = make_tileable(mesh_, creased ? creases() : std::vector<bool>());
    return *surface;
}

Result<MadeTiles> make_tiles(const TileableSurface& surface, const Mesh& mesh, const EncodeOptions& options,
                             StageClock& clock) {
    const Mesh& dense = surface.input.mesh;
    const bool lossless = options.rate.kind == RateTarget::Kind::kLossless;
    TileMapOptions map_options;
    map_options.squeeze = lossless ? kLosslessSqueeze : kCodedSqueeze;
    GIM_TRY(found, find_base(surface, options.tiles, options.samples, first_map(map_options, options.density), clock));
    auto& [tiles, map] = found;
    MadeTiles made;
    made.stretch_efficiency = stretch_efficiency(dense.positions, map);

    const uint32_t exponent = exponent_within(static_cast<uint32_t>(map.quads.size()), options.samples);
    if (options.density) {
        GIM_TRY(first, sample(surface.input, map, exponent));
        map_options.importance = importance_from(dense, map, first.atlas, lossless);
        GIM_TRY(adapted, map_tiles(dense, tiles.base, tiles.pairing.quads, map_options, clock.progress()));
        map = std::move(adapted);
    }

    clock.begin(Stage::kSample);
    GIM_TRY(sampled, sample(surface.input, map, exponent));
    made.tiles = std::move(sampled.tiles);
    made.atlas = std::move(sampled.atlas);
    made.rails = std::move(sampled.rails);
    std::optional<FitOptions> fit_options = first_fit(options);
    if (!fit_options) return made;

    clock.begin(Stage::kFit);
    fit_options->rails = made.rails;
    GIM_TRY(fitted, fit(made.atlas, mesh, *fit_options, clock.progress()));
    made.folds_before_fit = fitted.before.folds;
    made.atlas.positions = std::move(fitted.positions);
    return made;
}

}  // namespace gim

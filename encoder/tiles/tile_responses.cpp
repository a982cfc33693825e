#include "encoder/tiles/tile_responses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "encoder/tiles/tile_pyramid.h"

namespace gim {

namespace {

constexpr float kLeast = 0.02f;                // of the largest weight
constexpr size_t kMostKept = size_t{1} << 22;  // weights; more are forgotten
constexpr uint32_t kMostRings = 2;             // of tiles around; coarser details reach farther, but are only estimated

constexpr std::array<Orientation, 3> kOrientations = {Orientation::kHorizontal, Orientation::kVertical,
                                                      Orientation::kDiagonal};

// How far the function of a 9/7 detail reaches, in samples: 4 at the finest depth, and 3 more at each finer one.
uint32_t reach_at(uint32_t depth) { return (7u << (depth - 1)) - 3; }

Band size_of_band(uint32_t h, Orientation orientation) {
    return {nullptr, h + (orientation == Orientation::kHorizontal), h + (orientation == Orientation::kVertical)};
}

}  // namespace

TileResponses::TileResponses(const QuadComplex& complex, const TileShape& shape, const std::vector<uint32_t>& samples)
    : complex_(complex),
      shape_(shape),
      samples_(samples),
      first_at_(size_t{complex.vertices} + 1, 0),
      tiles_at_(complex.half_edges()) {
    for (uint32_t h = 0; h < complex.half_edges(); ++h) ++first_at_[complex.vertex[h] + 1];
    for (uint32_t v = 0; v < complex.vertices; ++v) first_at_[v + 1] += first_at_[v];
    std::vector<uint32_t> fill(first_at_.begin(), first_at_.end() - 1);
    for (uint32_t h = 0; h < complex.half_edges(); ++h) tiles_at_[fill[complex.vertex[h]]++] = tile_of(h);
}

uint64_t TileResponses::key_of(const PlaceInPart& place) {
    const uint64_t band = (uint64_t{place.part} << 6) | (place.depth << 2) | static_cast<uint32_t>(place.orientation);
    return (band << 32) | (uint64_t{place.row} << 16) | place.column;
}

WeightedSamples TileResponses::at(const PlaceInPart& place) {
    const uint64_t key = key_of(place);
    {
        const std::lock_guard lock(guards_known_);
        const auto found = known_.find(key);
        if (found != known_.end()) return found->second;
    }
    const Patch patch = patch_around(place.part, place.depth);
    Known found = weights_in(patch, synthesized(patch, place), place);
    WeightedSamples wanted = found.at(key);
    keep(std::move(found));
    return wanted;
}

// The other tiles around have zeros only, so it does not matter what the complex is there.
TileResponses::Patch TileResponses::patch_around(uint32_t tile, uint32_t depth) const {
    const uint32_t side = 1u << shape_.exponent;
    std::vector<uint32_t> tiles = {tile};
    for (uint32_t ring = 0; ring < std::min((reach_at(depth) + side - 1) / side, kMostRings); ++ring) {
        std::vector<uint32_t> larger;
        for (const uint32_t t : tiles) {
            for (uint32_t s = 0; s < 4; ++s) {
                const uint32_t v = complex_.vertex[4 * t + s];
                larger.insert(larger.end(), tiles_at_.begin() + first_at_[v], tiles_at_.begin() + first_at_[v + 1]);
            }
        }
        std::sort(larger.begin(), larger.end());
        larger.erase(std::unique(larger.begin(), larger.end()), larger.end());
        tiles = std::move(larger);
    }
    Patch patch{OwnComplex(static_cast<uint32_t>(tiles.size())), std::move(tiles)};
    QuadComplex& view = patch.complex.view();
    std::vector<uint32_t> vertices;  // of the whole complex, ascending
    for (const uint32_t t : patch.tiles)
        vertices.insert(vertices.end(), complex_.vertex + 4 * size_t{t}, complex_.vertex + 4 * size_t{t} + 4);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const auto place_in = [](const std::vector<uint32_t>& sorted, uint32_t value) {
        return static_cast<uint32_t>(std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin());
    };
    view.vertices = static_cast<uint32_t>(vertices.size());
    for (uint32_t v = 0; v < view.vertices; ++v) {
        view.valence[v] = complex_.valence[vertices[v]];
        view.on_boundary[v] = complex_.on_boundary[vertices[v]];
    }
    for (uint32_t h = 0; h < view.half_edges(); ++h) {
        const uint32_t from = 4 * patch.tiles[tile_of(h)] + side_of(h), mate = complex_.mate[from];
        view.vertex[h] = place_in(vertices, complex_.vertex[from]);
        view.mate[h] = kNoMate;
        if (mate != kNoMate) {
            const uint32_t other = place_in(patch.tiles, tile_of(mate));
            if (other < view.tiles && patch.tiles[other] == tile_of(mate)) view.mate[h] = 4 * other + side_of(mate);
        }
        if (view.mate[h] < h) {
            view.edge[h] = view.edge[view.mate[h]];
        } else {
            view.lower[view.edges] = h;
            view.edge[h] = view.edges++;
        }
    }
    return patch;
}

// Returns the grids of the patch. Their three components are the functions of the three details at the place.
std::vector<float> TileResponses::synthesized(const Patch& patch, const PlaceInPart& place) const {
    const QuadComplex& complex = patch.complex.view();
    TilePyramid<float> pyramid;
    pyramid.base.resize(3 * size_t{complex.vertices});
    for (uint32_t step = 0; step < shape_.exponent; ++step)
        pyramid.details.emplace_back(complex.tiles * TilePlanes(1u << step).details());
    const uint32_t step = shape_.exponent - place.depth;
    const TilePlanes planes(1u << step);
    const auto tile =
        static_cast<size_t>(std::lower_bound(patch.tiles.begin(), patch.tiles.end(), place.part) - patch.tiles.begin());
    float* details = pyramid.details[step].data() + tile * planes.details() - planes.horizontal();
    const ptrdiff_t starts[3] = {planes.horizontal(), planes.vertical(), planes.diagonal()};
    for (size_t k = 0; k < 3; ++k) {
        const Band size = size_of_band(planes.h, kOrientations[k]);
        if (place.row >= size.rows || place.column >= size.columns) continue;
        details[starts[k] + 3 * (ptrdiff_t{place.row} * size.columns + place.column) + static_cast<ptrdiff_t>(k)] = 1;
    }
    return shape_.is_sharp ? restore_tiles<TilesSharp>(complex, pyramid) : restore_tiles<Tiles97>(complex, pyramid);
}

TileResponses::Known TileResponses::weights_in(const Patch& patch, const std::vector<float>& grids,
                                               const PlaceInPart& place) const {
    const size_t size = ((size_t{1} << shape_.exponent) + 1) * ((size_t{1} << shape_.exponent) + 1);
    Known found;
    for (size_t k = 0; k < 3; ++k) {
        float most = 0;
        for (size_t i = k; i < grids.size(); i += 3) most = std::max(most, std::abs(grids[i]));
        if (most == 0) continue;  // there is no such detail, or it is that of another tile
        WeightedSamples& weights = found[key_of({place.part, place.depth, kOrientations[k], place.row, place.column})];
        for (size_t i = 0; i < grids.size() / 3; ++i) {
            const float weight = grids[3 * i + k];
            if (std::abs(weight) >= kLeast * most)
                weights.push_back({samples_[patch.tiles[i / size] * size + i % size], weight});
        }
    }
    return found;
}

void TileResponses::keep(Known more) {
    const std::lock_guard lock(guards_known_);
    if (kept_ > kMostKept) {
        known_.clear();
        kept_ = 0;
    }
    for (auto& [key, weights] : more) {
        const size_t count = weights.size();
        if (known_.emplace(key, std::move(weights)).second) kept_ += count;
    }
}

}  // namespace gim

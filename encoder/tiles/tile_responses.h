// How an image on tiles changes when one wavelet detail changes: the synthesis function of the detail, cut to where it
// matters. It is computed on the tiles around, and kept.
#pragma once

#include <cstdint>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "encoder/fit/coded_image.h"
#include "encoder/tiles/own_complex.h"
#include "format/quad_complex.h"
#include "format/tile_planes.h"

namespace gim {

class TileResponses {
  public:
    // samples: per tile its grid of samples, row by row, as numbers of samples of the image. Keeps references to it and to
    // the complex.
    TileResponses(const QuadComplex& complex, const TileShape& shape, const std::vector<uint32_t>& samples);

    // Returns what a detail moves. place: a source; its part is a tile. Leaves out what is less than 2 % of the largest
    // weight. The first call for a place costs a synthesis of the tiles around. Several threads may call it at once.
    WeightedSamples at(const PlaceInPart& place);

  private:
    struct Patch {
        OwnComplex complex;
        std::vector<uint32_t> tiles;  // of the whole complex, ascending
    };
    Patch patch_around(uint32_t tile, uint32_t depth) const;
    std::vector<float> synthesized(const Patch& patch, const PlaceInPart& place) const;
    using Known = std::unordered_map<uint64_t, WeightedSamples>;
    Known weights_in(const Patch& patch, const std::vector<float>& grids, const PlaceInPart& place) const;
    void keep(Known more);
    static uint64_t key_of(const PlaceInPart& place);

    const QuadComplex& complex_;
    TileShape shape_;
    const std::vector<uint32_t>& samples_;
    std::vector<uint32_t> first_at_,
        tiles_at_;  // tiles at each vertex: tiles_at_[first_at_[v] .. first_at_[v + 1] - 1]
    std::mutex guards_known_;
    Known known_;
    size_t kept_ = 0;  // weights
};

}  // namespace gim

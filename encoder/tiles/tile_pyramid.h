// Splits an image on a complex of tiles into a base and details, and quantizes them. Mirror of the decoder's
// tile_decoder.h.  spec/gim-format.md, "Tiles".
#pragma once

#include <cstdint>
#include <vector>

#include "format/container.h"
#include "format/detail_frame.h"
#include "format/quad_complex.h"

namespace gim {

template <class Sample>
struct TilePyramid {
    std::vector<Sample> base;                  // triples, per vertex
    std::vector<std::vector<Sample>> details;  // per step, coarsest first; tile by tile, as TilePlanes orders them

    uint32_t steps() const { return static_cast<uint32_t>(details.size()); }
};

// grids: per tile (2^exponent + 1)^2 triples, equal where tiles share samples. Cost: O(samples).
template <class Wavelet>
TilePyramid<typename Wavelet::Sample> analyse_tiles(const QuadComplex& complex,
                                                    std::vector<typename Wavelet::Sample> grids, uint32_t exponent);

// The inverse, up to rounding of floats.
template <class Wavelet>
std::vector<typename Wavelet::Sample> restore_tiles(const QuadComplex& complex,
                                                    const TilePyramid<typename Wavelet::Sample>& pyramid);

// Rounds base and details to multiples of their steps. Frames of details come from the image that a decoder has at that
// step. Details on edges are right in the tile of the lower half-edge only. decoded: gets the grids of a decoder, up to
// rounding.
template <class Wavelet>
TilePyramid<int32_t> quantize_tiles(const QuadComplex& complex, const TileShape& shape,
                                    const TilePyramid<float>& pyramid, const DetailCoding& coding,
                                    std::vector<float>* decoded = nullptr);

}  // namespace gim

// Splits an image on a complex of tiles into a base and details, and quantizes them. Mirror of the decoder's
// tile_decoder.h.  spec/gim-format.md, "Tiles".
#pragma once

#include <cstdint>
#include <vector>

#include "format/container.h"
#include "format/detail_frame.h"
#include "format/quad_complex.h"
#include "format/tile_lifting.h"
#include "format/tile_planes.h"

namespace gim {

template <class Sample>
struct TilePyramid {
    std::vector<Sample> base;                  // triples, per vertex
    std::vector<std::vector<Sample>> details;  // per step, coarsest first; tile by tile, as TilePlanes orders them

    uint32_t steps() const { return static_cast<uint32_t>(details.size()); }
};

// Splits the samples of all tiles, once. Small images keep the values of constant images.
template <class Wavelet>
void analyse_step(const QuadComplex& complex, const TilePlanes& planes, typename Wavelet::Sample* samples,
                  typename Wavelet::Sum* sums);

// Calls step(planes, samples) with the samples of all tiles from the finest step on, and takes the small images on to the
// next one. is_sum: the base of a vertex is the sum of what its tiles have; else they have the same.
template <class Sample, class Step>
TilePyramid<Sample> split_tiles(const QuadComplex& complex, std::vector<Sample> grids, uint32_t exponent,
                                const Step& step, bool is_sum = false) {
    TilePyramid<Sample> pyramid;
    pyramid.details.resize(exponent);
    for (uint32_t e = exponent; e > 0; --e) {
        const TilePlanes planes(1u << (e - 1));
        std::vector<Sample> samples(complex.tiles * planes.size());
        for (uint32_t t = 0; t < complex.tiles; ++t)
            split_planes(planes, grids.data() + t * planes.size(), samples.data() + t * planes.size());
        step(planes, samples.data());
        std::vector<Sample>& details = pyramid.details[e - 1];
        details.reserve(complex.tiles * planes.details());
        grids.clear();
        for (uint32_t t = 0; t < complex.tiles; ++t) {
            const auto tile = samples.begin() + static_cast<ptrdiff_t>(t * planes.size());
            grids.insert(grids.end(), tile, tile + planes.horizontal());
            details.insert(details.end(), tile + planes.horizontal(), tile + static_cast<ptrdiff_t>(planes.size()));
        }
    }
    pyramid.base.resize(3 * size_t{complex.vertices});
    static constexpr size_t kCorner[4] = {0, 1, 3, 2};  // of 2 x 2 samples
    for (size_t h = 0; h < complex.half_edges(); ++h) {
        for (size_t k = 0; k < 3; ++k) {
            Sample& to = pyramid.base[3 * size_t{complex.vertex[h]} + k];
            const Sample from = grids[12 * (h / 4) + 3 * kCorner[h % 4] + k];
            to = is_sum ? to + from : from;
        }
    }
    return pyramid;
}

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

// What a decoder makes of such integers, up to rounding: for each step the planes of all tiles with the small images that
// it begins with, coarsest first; then the grids. Details on edges are read from the tile of the lower half-edge.
template <class Wavelet>
std::vector<std::vector<float>> decode_tiles(const QuadComplex& complex, const TileShape& shape,
                                             const TilePyramid<int32_t>& pyramid, const DetailCoding& coding);

}  // namespace gim

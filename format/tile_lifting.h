// The wavelets of squares on a complex of tiles. spec/gim-format.md, "Tiles".
//
// Inside a tile each lifting step runs along rows and along columns, as on a square. Each step looks at direct neighbours
// only. So a step goes on across the border of a tile, and around a vertex of any valence: there a low sample gets what
// it would get from four tiles, times valence / 4. At a boundary the surface is mirrored.
// After: Daubechies, Sweldens (format/lifting.h); Bertram, Duchaineau, Hamann, Joy. Generalized B-Spline Subdivision-
// Surface Wavelets for Geometry Compression. 2004 (lifting around vertices of any valence).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "format/lifting.h"
#include "format/quad_complex.h"
#include "format/tile_planes.h"
#include "format/tile_steps.h"

namespace gim {

// 5/3 on binary32. It predicts a detail from its two neighbours alone, so that creases do not ring.
struct Irreversible53 {
    using Sample = float;
    static constexpr int kSteps = 2;
    static constexpr std::array<float, 2> kFactor = {-0.5f, 0.25f};
    static constexpr float kLowGain = 1;
};

// The wavelets, as types. Sum: of details around a vertex.
struct Tiles53 : Reversible53 {
    using Sum = int64_t;
    static const TileArithmetic& arithmetic() { return kTiles53; }
};
struct Tiles97 : Irreversible97 {
    using Sum = float;
    static const TileArithmetic& arithmetic() { return kTiles97; }
};
struct TilesSharp : Irreversible53 {
    using Sum = float;
    static const TileArithmetic& arithmetic() { return kTilesSharp; }
};

// TileSteps of a wavelet.
template <class Wavelet>
class TileLifting : public TileSteps {
  public:
    TileLifting(const QuadComplex& complex, const TilePlanes& planes, typename Wavelet::Sample* samples,
                typename Wavelet::Sum* sums)
        : TileSteps(Wavelet::arithmetic(), complex, planes, samples, sums) {}
};

// Interleaves the planes of a tile into a grid of (2h+1) x (2h+1) samples, or back.
template <class Sample>
void join_planes(const TilePlanes& planes, const Sample* tile, Sample* grid) {
    const size_t h = planes.h, row = 3 * h, low_row = row + 3, width = 3 * (2 * h + 1);
    const auto interleave = [&](const Sample* low, const Sample* high, Sample* to) {
        for (size_t i = 0; i < h; ++i) {
            std::copy_n(low + 3 * i, 3, to + 6 * i);
            std::copy_n(high + 3 * i, 3, to + 6 * i + 3);
        }
        std::copy_n(low + row, 3, to + 2 * row);
    };
    for (size_t r = 0; r <= h; ++r) {
        interleave(tile + r * low_row, tile + planes.horizontal() + r * row, grid + 2 * r * width);
        if (r < h)
            interleave(tile + planes.vertical() + r * low_row, tile + planes.diagonal() + r * row,
                       grid + (2 * r + 1) * width);
    }
}
template <class Sample>
void split_planes(const TilePlanes& planes, const Sample* grid, Sample* tile) {
    const size_t h = planes.h, row = 3 * h, low_row = row + 3, width = 3 * (2 * h + 1);
    const auto split = [&](const Sample* from, Sample* low, Sample* high) {
        for (size_t i = 0; i < h; ++i) {
            std::copy_n(from + 6 * i, 3, low + 3 * i);
            std::copy_n(from + 6 * i + 3, 3, high + 3 * i);
        }
        std::copy_n(from + 2 * row, 3, low + row);
    };
    for (size_t r = 0; r <= h; ++r) {
        split(grid + 2 * r * width, tile + r * low_row, tile + planes.horizontal() + r * row);
        if (r < h)
            split(grid + (2 * r + 1) * width, tile + planes.vertical() + r * low_row,
                  tile + planes.diagonal() + r * row);
    }
}

}  // namespace gim

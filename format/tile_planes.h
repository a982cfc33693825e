// How the samples of a tile lie in memory during a wavelet step: the small image of (h+1) x (h+1) samples and three
// bands of details, plane after plane, as triples. Samples on the border of a tile are in every tile that they belong to.
// spec/gim-format.md, "Tiles".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "format/band.h"

namespace gim {

// Where a run of triples begins and how far the next one is, in numbers.
struct Run {
    ptrdiff_t start = 0, stride = 0;
    ptrdiff_t at(uint32_t i) const { return start + static_cast<ptrdiff_t>(i) * stride; }
};

// What lies along a side of a tile, in the direction of its half-edge.
struct TileSide {
    Run low;     // h + 1 samples of the small image on the side
    Run inner;   // the h + 1 samples of the small image in the row beside them
    Run high;    // h details on the side
    Run faces;   // h details of the cells beside them
    Run across;  // i = 1 .. h-1: details beside low sample i, in the row of `faces`
};

class TilePlanes {
  public:
    explicit TilePlanes(uint32_t small_intervals) : h(small_intervals) {
        const ptrdiff_t n = h, one = 3, row = 3 * n, low_row = 3 * (n + 1);
        const ptrdiff_t hz = horizontal(), vt = vertical(), dg = diagonal();
        // From the corner where a side starts: along the side, and inwards.
        sides[0] = {{0, one}, {low_row, one}, {hz, one}, {dg, one}, {vt, one}};
        sides[1] = {
            {row, low_row}, {row - one, low_row}, {vt + row, low_row}, {dg + row - one, row}, {hz + row - one, row}};
        sides[2] = {{n * low_row + row, -one},
                    {(n - 1) * low_row + row, -one},
                    {hz + n * row + row - one, -one},
                    {dg + (n - 1) * row + row - one, -one},
                    {vt + (n - 1) * low_row + row, -one}};
        sides[3] = {{n * low_row, -low_row},
                    {n * low_row + one, -low_row},
                    {vt + (n - 1) * low_row, -low_row},
                    {dg + (n - 1) * row, -row},
                    {hz + n * row, -row}};
    }

    uint32_t h;
    std::array<TileSide, 4> sides;

    // Offsets of the planes. The small image is the first.
    ptrdiff_t horizontal() const { return 3 * static_cast<ptrdiff_t>(h + 1) * (h + 1); }
    ptrdiff_t vertical() const { return horizontal() + 3 * static_cast<ptrdiff_t>(h + 1) * h; }
    ptrdiff_t diagonal() const { return vertical() + 3 * static_cast<ptrdiff_t>(h + 1) * h; }
    // Numbers of a tile, and of its details alone.
    size_t size() const { return 3 * size_t{2 * h + 1} * (2 * h + 1); }
    size_t details() const { return size() - static_cast<size_t>(horizontal()); }

    // Bands in an array of details alone.
    LevelBands bands(int32_t* details) const {
        return {{details, h + 1, h},
                {details + (vertical() - horizontal()), h, h + 1},
                {details + (diagonal() - horizontal()), h, h}};
    }
};

}  // namespace gim

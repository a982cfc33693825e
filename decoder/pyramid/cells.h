// Splits cells of a grid into triangles.  spec/gim-format.md, "Triangles".
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/inline.h"

namespace gim {

// a b   a is the first sample of the cell; rows go down, columns to the right. From outside the row axis points up, so
// c d   that a, b, d is counter-clockwise (format/ring.h).
inline void write_cell(uint32_t a, uint32_t b, uint32_t c, uint32_t d, bool main, uint32_t* out) {
    out[0] = a;
    out[1] = b;
    out[2] = main ? d : c;
    out[3] = main ? a : b;
    out[4] = d;
    out[5] = c;
}

// As write_cell, for a row of cells. above, below: the vertices of both rows, one more than cells. is_main: 0 or 1 for each.
GIM_NEVER_INLINE void write_cells(const uint32_t* above, const uint32_t* below, const uint32_t* is_main, uint32_t cells,
                                  uint32_t* __restrict out);
// The same for vertices that rise by 1 along both rows, from a and from c on.
GIM_NEVER_INLINE void write_rising_cells(uint32_t a, uint32_t c, const uint32_t* is_main, uint32_t cells,
                                         uint32_t* __restrict out);

// Splits a row of samples into x, y and z, so that compilers vectorise loops over it.
GIM_NEVER_INLINE void split_row(const float* samples, size_t side, float* __restrict row);

// Sets is_main to 1 for each cell between two split rows whose main diagonal is not longer than the other, else to 0.
GIM_NEVER_INLINE void find_shorter_main(const float* __restrict a, const float* __restrict c, size_t side,
                                        uint32_t* __restrict is_main);

}  // namespace gim

// Splits cells of a grid into triangles.  spec/gim-format.md, "Triangles".
#pragma once

#include <cstddef>
#include <cstdint>

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

// Splits a row of samples into x, y and z, so that compilers vectorise loops over it.
inline void split_row(const float* samples, size_t side, float* __restrict row) {
    for (size_t i = 0; i < side; ++i) {
        row[i] = samples[3 * i];
        row[side + i] = samples[3 * i + 1];
        row[2 * side + i] = samples[3 * i + 2];
    }
}

// Sets is_main to 1 for each cell between two split rows whose main diagonal is not longer than the other, else to 0.
inline void find_shorter_main(const float* __restrict a, const float* __restrict c, size_t side,
                              uint32_t* __restrict is_main) {
    const auto squared = [](float x, float y, float z) { return x * x + y * y + z * z; };
    for (size_t i = 0; i + 1 < side; ++i) {
        const size_t x = i, y = side + i, z = 2 * side + i;
        const float main = squared(a[x] - c[x + 1], a[y] - c[y + 1], a[z] - c[z + 1]);
        const float anti = squared(a[x + 1] - c[x], a[y + 1] - c[y], a[z + 1] - c[z]);
        is_main[i] = main <= anti ? 1 : 0;
    }
}

}  // namespace gim

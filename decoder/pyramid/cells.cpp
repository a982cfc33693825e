#include "decoder/pyramid/cells.h"

namespace gim {

GIM_VECTOR_CLONES void write_cells(const uint32_t* above, const uint32_t* below, const uint32_t* is_main,
                                   uint32_t cells, uint32_t* __restrict out) {
    for (uint32_t i = 0; i < cells; ++i, out += 6)
        write_cell(above[i], above[i + 1], below[i], below[i + 1], is_main[i] != 0, out);
}

GIM_VECTOR_CLONES void write_rising_cells(uint32_t a, uint32_t c, const uint32_t* is_main, uint32_t cells,
                                          uint32_t* __restrict out) {
    const uint32_t b = a + 1, d = c + 1;
    for (uint32_t i = 0; i < cells; ++i, out += 6) {
        const bool main = is_main[i] != 0;
        out[0] = a + i;
        out[1] = b + i;
        out[2] = main ? d + i : c + i;
        out[3] = main ? a + i : b + i;
        out[4] = d + i;
        out[5] = c + i;
    }
}

GIM_VECTOR_CLONES void split_row(const float* samples, size_t side, float* __restrict row) {
    for (size_t i = 0; i < side; ++i) {
        row[i] = samples[3 * i];
        row[side + i] = samples[3 * i + 1];
        row[2 * side + i] = samples[3 * i + 2];
    }
}

GIM_VECTOR_CLONES void find_shorter_main(const float* __restrict a, const float* __restrict c, size_t side,
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

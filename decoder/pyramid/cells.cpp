#include "decoder/pyramid/cells.h"

namespace gim {

void split_row(const float* samples, size_t side, float* __restrict row) {
    for (size_t i = 0; i < side; ++i) {
        row[i] = samples[3 * i];
        row[side + i] = samples[3 * i + 1];
        row[2 * side + i] = samples[3 * i + 2];
    }
}

void find_shorter_main(const float* __restrict a, const float* __restrict c, size_t side,
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

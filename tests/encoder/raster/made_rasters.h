// Images of other programs, made of whole numbers.
#pragma once

#include <cstdint>

#include "gim/encoder.h"

namespace gim::test {

using MaskRule = bool (*)(uint32_t row, uint32_t column);

inline bool all_defined(uint32_t, uint32_t) { return true; }
// A hole, gaps between pieces, pieces that touch at a corner, single samples.
inline bool with_holes(uint32_t row, uint32_t column) {
    const bool is_hole = row % 8 >= 3 && row % 8 <= 4 && column % 9 >= 2 && column % 9 <= 4;
    const bool is_gap = column % 9 == 6 && row % 5 != 2;
    const bool is_single = column % 9 == 8 && row % 3 != 1;
    return !is_hole && !is_gap && !is_single;
}

// A hill over the columns and rows, with other channels of the same kind.
inline RasterImage raster_of(uint32_t width, uint32_t height, MaskRule mask, uint32_t channels) {
    RasterImage image;
    image.width = width;
    image.height = height;
    image.channels = channels;
    image.type = SampleType::kUint16;
    image.mask = RasterImage::Mask::kArray;
    for (uint32_t r = 0; r < height; ++r) {
        for (uint32_t c = 0; c < width; ++c) {
            image.defined.push_back(mask(r, c) ? 1 : 0);
            const uint32_t u = c * 1024 / width, v = r * 1024 / height;
            const uint32_t hill = u * (1024 - u) / 512 * (v * (1024 - v) / 512) / 64;
            for (uint32_t k = 0; k < channels; ++k) {
                const uint32_t plain[] = {100 + 3 * u + v / 8, 50 + 2 * v + u * u / 4096, 7 + hill};
                image.values.push_back(image.defined.back() ? plain[k % 3] + 5 * (k / 3) : 0);
            }
        }
    }
    return image;
}

// A tube that is cut into two pieces, which lie one beside the other: 2 * `height` samples around. Where the pieces meet,
// positions are equal, but for `off` in one component of each second sample.
inline RasterImage folded_raster(uint32_t width, uint32_t height, uint32_t off) {
    RasterImage image = raster_of(width, 2 * height + 1, all_defined, 3);
    const int32_t around[12] = {1000, 866, 500, 0, -500, -866, -1000, -866, -500, 0, 500, 866};
    for (uint32_t r = 0; r < image.height; ++r) {
        for (uint32_t c = 0; c < width; ++c) {
            const bool is_defined = r != height;
            const uint32_t turn = r < height ? r : r - 2;  // both pieces have the samples of both borders
            image.defined[r * width + c] = is_defined ? 1 : 0;
            double* v = &image.values[(size_t{r} * width + c) * 3];
            const uint32_t steps = 2 * (height - 1), at = turn % steps;
            const uint32_t angle = at * 12 / steps, rest = at * 12 % steps;
            const auto mix = [&](uint32_t shift) {
                const int32_t a = around[(angle + shift) % 12], b = around[(angle + shift + 1) % 12];
                return 2000 + a + (b - a) * static_cast<int32_t>(rest) / static_cast<int32_t>(steps);
            };
            const uint32_t rough = (at * at * 31 + c * c * 17 + at * c * 13) % 37;
            v[0] = is_defined ? mix(0) + rough + (r > height && c % 2 == 1 ? off : 0) : 0;
            v[1] = is_defined ? mix(9) + rough : 0;
            v[2] = is_defined ? 40 * c + rough : 0;
        }
    }
    return image;
}

}  // namespace gim::test

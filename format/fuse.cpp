#include "format/fuse.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "format/ring.h"

namespace gim {
namespace {

float* sample_at(float* samples, uint32_t side, uint32_t depth, GridPoint p) {
    return samples + (size_t{p.row + depth} * side + p.column + depth) * 3;
}

// Ring `depth` gets decay * the mean of the outer corrections next to it: three of them, five at its corners.
void diffuse(uint32_t side, uint32_t depth, float decay, float* samples, const float* outer, float* __restrict inner) {
    const uint32_t edge = side - 1 - 2 * depth;  // samples of this ring per side of the square
    const uint32_t outer_ring = 4 * (edge + 2);
    for (uint32_t s = 0; s < 4; ++s) {
        const uint32_t first = s * edge, outer_first = s * (edge + 2);
        for (size_t k = 0; k < 3; ++k) {
            float sum = 0;
            for (uint32_t n = 0; n < 5; ++n)
                sum = sum + outer[size_t{(outer_first + outer_ring - 2 + n) % outer_ring} * 3 + k];
            inner[size_t{first} * 3 + k] = decayed_mean(sum, 5, decay);
        }
        const float *a = outer + size_t{outer_first + 1} * 3, *b = a + 3, *c = b + 3;
        float* corrections = inner + size_t{first + 1} * 3;
        for (size_t i = 0; i < size_t{edge - 1} * 3; ++i)
            corrections[i] = decayed_mean(((0.0f + a[i]) + b[i]) + c[i], 3, decay);

        float* x = sample_at(samples, side, depth, ring_point(edge + 1, first));
        const ptrdiff_t next = sample_at(samples, side, depth, ring_point(edge + 1, first + 1)) - x;
        for (uint32_t t = 0; t < edge; ++t, x += next)
            for (size_t k = 0; k < 3; ++k) x[k] = x[k] + inner[size_t{first + t} * 3 + k];
    }
}

}  // namespace

uint32_t diffusion_width(uint32_t side) {
    const uint32_t innermost = (side - 1) / 2;  // the ring at this depth is a single sample
    return std::min(std::max(2u, side / 16), innermost - 1);
}

bool average_classes(uint32_t side, const uint32_t* class_of, uint32_t class_count, float* samples,
                     const FuseWork& work) {
    const auto for_each = [side, class_of](const auto& f) {
        for (uint32_t i = 0; i < ring_length(side); ++i) {
            const GridPoint p = ring_point(side, i);
            f(size_t{p.row} * side + p.column, class_of[i], size_t{i});
        }
    };
    return average_points(for_each, class_count, samples, work.outer, work);
}

void fuse(uint32_t side, const uint32_t* class_of, uint32_t class_count, float* samples, const FuseWork& work) {
    if (!average_classes(side, class_of, class_count, samples, work)) return;
    const uint32_t width = diffusion_width(side);
    float* outer = work.outer;
    float* inner = work.inner;
    for (uint32_t depth = 1; depth <= width; ++depth) {
        diffuse(side, depth, correction_decay(depth, width), samples, outer, inner);
        std::swap(outer, inner);
    }
}

}  // namespace gim

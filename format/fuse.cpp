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

// decay * the mean of `count` outer corrections.
void decayed_mean(const float* const* corrections, uint32_t count, float decay, float* mean) {
    for (int k = 0; k < 3; ++k) {
        float sum = 0;
        for (uint32_t n = 0; n < count; ++n) sum = sum + corrections[n][k];
        mean[k] = decay * (sum / static_cast<float>(count));
    }
}

// Ring `depth` gets decay * the mean of the outer corrections next to it: three of them, five at its corners.
void diffuse(uint32_t side, uint32_t depth, float decay, float* samples, const float* outer, float* __restrict inner) {
    const uint32_t edge = side - 1 - 2 * depth;  // samples of this ring per side of the square
    const uint32_t outer_ring = 4 * (edge + 2);
    for (uint32_t s = 0; s < 4; ++s) {
        const uint32_t first = s * edge, outer_first = s * (edge + 2);
        const float* five[5];
        for (uint32_t n = 0; n < 5; ++n) five[n] = outer + size_t{(outer_first + outer_ring - 2 + n) % outer_ring} * 3;
        decayed_mean(five, 5, decay, inner + size_t{first} * 3);
        const float *a = outer + size_t{outer_first + 1} * 3, *b = a + 3, *c = b + 3;
        float* corrections = inner + size_t{first + 1} * 3;
        for (size_t i = 0; i < size_t{edge - 1} * 3; ++i)
            corrections[i] = decay * ((((0.0f + a[i]) + b[i]) + c[i]) / 3.0f);

        float* x = sample_at(samples, side, depth, ring_point(edge + 1, first));
        const ptrdiff_t next = sample_at(samples, side, depth, ring_point(edge + 1, first + 1)) - x;
        for (uint32_t t = 0; t < edge; ++t, x += next)
            for (size_t k = 0; k < 3; ++k) x[k] = x[k] + inner[size_t{first + t} * 3 + k];
    }
}

}  // namespace

uint32_t diffusion_width(uint32_t side) {
    const uint32_t innermost = (side - 1) / 2;  // the depth that is a single sample
    return std::min(std::max(2u, side / 16), innermost - 1);
}

bool average_classes(uint32_t side, const uint32_t* class_of, uint32_t class_count, float* samples,
                     const FuseWork& work) {
    const uint32_t ring = ring_length(side);
    std::fill_n(work.members, class_count, 0u);
    for (uint32_t i = 0; i < ring; ++i) {
        const uint32_t c = class_of[i];
        const float* x = sample_at(samples, side, 0, ring_point(side, i));
        float* sum = work.sums + size_t{c} * 3;
        if (work.members[c]++ == 0) {
            work.first[c] = i;
            std::fill_n(sum, 3, 0.0f);
            continue;
        }
        const float* x0 = sample_at(samples, side, 0, ring_point(side, work.first[c]));
        for (int k = 0; k < 3; ++k) sum[k] = sum[k] + (x[k] - x0[k]);
    }
    bool changed = false;
    for (uint32_t c = 0; c < class_count; ++c) {
        const float* x0 = sample_at(samples, side, 0, ring_point(side, work.first[c]));
        float* mean = work.sums + size_t{c} * 3;
        for (int k = 0; k < 3; ++k) mean[k] = x0[k] + mean[k] / static_cast<float>(work.members[c]);
    }
    for (uint32_t i = 0; i < ring; ++i) {
        float* x = sample_at(samples, side, 0, ring_point(side, i));
        const float* mean = work.sums + size_t{class_of[i]} * 3;
        for (int k = 0; k < 3; ++k) {
            work.outer[size_t{i} * 3 + k] = mean[k] - x[k];
            changed = changed || mean[k] != x[k];
            x[k] = mean[k];
        }
    }
    return changed;
}

void fuse(uint32_t side, const uint32_t* class_of, uint32_t class_count, float* samples, const FuseWork& work) {
    if (!average_classes(side, class_of, class_count, samples, work)) return;
    const uint32_t width = diffusion_width(side);
    float* outer = work.outer;
    float* inner = work.inner;
    for (uint32_t depth = 1; depth <= width; ++depth) {
        // Together a ramp: 1 on the rim, 0 at depth width + 1.
        const float decay = static_cast<float>(width + 1 - depth) / static_cast<float>(width + 2 - depth);
        diffuse(side, depth, decay, samples, outer, inner);
        std::swap(outer, inner);
    }
}

}  // namespace gim

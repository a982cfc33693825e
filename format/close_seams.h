// Closes seams in any layout: every sample of a surface point becomes the mean of them all, and the correction fades
// out into the interior along a linear ramp.  spec/gim-format.md, "Fusing", "Charts".
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace gim {

// Work space of average_points.
struct PointWork {
    float* sums = nullptr;        // 3 per point: sum of the differences to the point's first sample
    uint32_t* first = nullptr;    // per point: its first sample
    uint32_t* members = nullptr;  // per point: its number of samples
};

// Gives each sample of a seam the mean over its point, as first + sum(differences) / members: exact if all are equal.
// for_each(f) calls f(sample, point, slot) for every sample of a seam, always in the same order. What was added goes to
// corrections[3 * slot] and the next two. Returns false if no sample changes.
template <class ForEach>
bool average_points(const ForEach& for_each, uint32_t point_count, float* samples, float* corrections,
                    const PointWork& work) {
    std::fill_n(work.members, point_count, 0u);
    for_each([&](size_t sample, uint32_t point, size_t) {
        float* sum = work.sums + size_t{point} * 3;
        if (work.members[point]++ == 0) {
            work.first[point] = static_cast<uint32_t>(sample);
            std::fill_n(sum, 3, 0.0f);
            return;
        }
        const float *x = samples + sample * 3, *x0 = samples + size_t{work.first[point]} * 3;
        for (size_t k = 0; k < 3; ++k) sum[k] = sum[k] + (x[k] - x0[k]);
    });
    for (uint32_t p = 0; p < point_count; ++p) {
        if (work.members[p] == 0) continue;
        const float* x0 = samples + size_t{work.first[p]} * 3;
        float* mean = work.sums + size_t{p} * 3;
        for (size_t k = 0; k < 3; ++k) mean[k] = x0[k] + mean[k] / static_cast<float>(work.members[p]);
    }
    bool changed = false;
    for_each([&](size_t sample, uint32_t point, size_t slot) {
        const float* mean = work.sums + size_t{point} * 3;
        for (size_t k = 0; k < 3; ++k) {
            float& x = samples[sample * 3 + k];
            corrections[slot * 3 + k] = mean[k] - x;
            changed |= mean[k] != x;
            x = mean[k];
        }
    });
    return changed;
}

// The part of its correction that the layer outside passes on to layer `depth`. All layers form a ramp: 1 on the seam,
// 0 at depth width + 1.
inline float correction_decay(uint32_t depth, uint32_t width) {
    return static_cast<float>(width + 1 - depth) / static_cast<float>(width + 2 - depth);
}

// The correction of a sample, from the sum over its `count` neighbours in the layer outside.
inline float decayed_mean(float sum, uint32_t count, float decay) { return decay * (sum / static_cast<float>(count)); }

}  // namespace gim

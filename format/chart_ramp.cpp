#include "format/chart_ramp.h"

#include <algorithm>
#include <array>

#include "format/close_seams.h"

namespace gim {

uint32_t chart_diffusion_width(uint32_t columns, uint32_t rows) {
    return std::clamp(std::min(columns, rows) / 8, 2u, 16u);
}

void spread_corrections(const ChartRamp& chart, std::span<const uint32_t> border, uint32_t* queue) {
    const uint32_t width = chart_diffusion_width(chart.columns, chart.rows);
    uint8_t* depth = chart.depth;
    float *corrections = chart.corrections, *x = chart.samples;
    uint32_t begin = 0, end = 0;
    for (const uint32_t sample : border) queue[end++] = sample;
    // All eight neighbours of an inner sample are in the box.
    const auto stride = static_cast<int32_t>(chart.columns);
    const std::array<int32_t, 8> around = {-stride - 1, -stride, -stride + 1, -1, 1, stride - 1, stride, stride + 1};
    const auto neighbour = [](uint32_t i, int32_t offset) { return i + static_cast<uint32_t>(offset); };
    const auto reach = [&](uint32_t i, uint32_t layer) {
        if (depth[i] != kInside) return;
        depth[i] = static_cast<uint8_t>(layer);
        queue[end++] = i;
    };
    for (uint32_t layer = 1; layer <= width; ++layer) {
        const uint32_t last = end;
        for (; begin < last; ++begin) {
            if (layer == 1) {
                const uint32_t row = queue[begin] / chart.columns, column = queue[begin] % chart.columns;
                for (uint32_t r = row > 0 ? row - 1 : 0; r <= row + 1 && r < chart.rows; ++r) {
                    for (uint32_t c = column > 0 ? column - 1 : 0; c <= column + 1 && c < chart.columns; ++c)
                        reach(r * chart.columns + c, layer);
                }
            } else {
                for (const int32_t offset : around) reach(neighbour(queue[begin], offset), layer);
            }
        }
        const float decay = correction_decay(layer, width);
        for (uint32_t q = last; q < end; ++q) {
            const uint32_t i = queue[q];
            float sum[3] = {0, 0, 0};
            uint32_t count = 0;
            for (const int32_t offset : around) {
                const uint32_t j = neighbour(i, offset);
                if (depth[j] + 1u != layer) continue;
                for (size_t k = 0; k < 3; ++k) sum[k] = sum[k] + corrections[size_t{j} * 3 + k];
                ++count;
            }
            for (size_t k = 0; k < 3; ++k) {
                const float correction = decayed_mean(sum[k], count, decay);
                corrections[size_t{i} * 3 + k] = correction;
                x[size_t{i} * 3 + k] = x[size_t{i} * 3 + k] + correction;
            }
        }
    }
}

}  // namespace gim

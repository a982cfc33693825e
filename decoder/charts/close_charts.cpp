#include "decoder/charts/close_charts.h"

#include <algorithm>
#include <array>

#include "format/close_seams.h"

namespace gim {
namespace {

// Spreads the corrections inwards, layer by layer. Each sample gets a part of the mean over its neighbours that lie one
// step nearer to the border.
void diffuse(const DecodedChart& chart, const ChartWorkspace& ws, float* samples) {
    const uint32_t width = chart_diffusion_width(chart.columns, chart.rows);
    uint8_t* depth = ws.depth + chart.first;
    float* corrections = ws.corrections + size_t{chart.first} * 3;
    float* x = samples + size_t{chart.first} * 3;
    uint32_t* queue = ws.queue;
    uint32_t begin = 0, end = 0;
    for (uint32_t k = 0; k < chart.border.border_length; ++k) queue[end++] = chart.border.samples[k];
    // All eight neighbours of an inner sample are in the box.
    const auto stride = static_cast<int32_t>(chart.columns);
    const std::array<int32_t, 8> around = {-stride - 1, -stride, -stride + 1, -1, 1, stride - 1, stride, stride + 1};
    const auto neighbour = [](uint32_t i, int32_t offset) { return i + static_cast<uint32_t>(offset); };
    for (uint32_t layer = 1; layer <= width; ++layer) {
        const uint32_t last = end;
        for (; begin < last; ++begin) {
            const uint32_t row = queue[begin] / chart.columns, column = queue[begin] % chart.columns;
            for (const int32_t offset : around) {
                const bool outside =
                    (column == 0 && (offset == -1 || offset == stride - 1 || offset == -stride - 1)) ||
                    (column + 1 == chart.columns && (offset == 1 || offset == stride + 1 || offset == -stride + 1)) ||
                    (row == 0 && offset < -1) || (row + 1 == chart.rows && offset > 1);
                if (outside) continue;
                const uint32_t i = neighbour(queue[begin], offset);
                if (depth[i] != kInside) continue;
                depth[i] = static_cast<uint8_t>(layer);
                queue[end++] = i;
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

}  // namespace

uint32_t chart_diffusion_width(uint32_t columns, uint32_t rows) {
    return std::clamp(std::min(columns, rows) / 8, 2u, 16u);
}

void close_charts(const ChartLevelShape& shape, const ChartWorkspace& ws, float* samples) {
    const auto for_each = [&](const auto& f) {
        for (uint32_t i = 0; i < shape.samples; ++i) {
            if (ws.depth[i] == kOnBorder) f(size_t{i}, ws.point[i], size_t{i});
        }
    };
    // `queue` holds the first samples until diffuse needs it.
    const PointWork work = {ws.sums, ws.queue, ws.members};
    if (!average_points(for_each, shape.size.vertices, samples, ws.corrections, work)) return;
    for (uint32_t c = 0; c < shape.chart_count; ++c) diffuse(ws.charts[c], ws, samples);
}

}  // namespace gim

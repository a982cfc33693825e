#include "decoder/charts/close_charts.h"

#include <bit>

#include "format/chart_ramp.h"
#include "format/close_seams.h"

namespace gim {
namespace {

// Calls f(i) for every border sample, in order. Looks at eight at a time, without a branch for each.
template <class F>
void for_each_border_sample(const uint8_t* depth, size_t count, const F& f) {
    static_assert(kOnBorder == 0);
    constexpr uint64_t kLows = 0x7F7F7F7F7F7F7F7Fu;
    size_t i = 0;
    for (; i + 8 <= count; i += 8) {
        uint64_t group = 0;  // compilers load it at once
        for (size_t k = 0; k < 8; ++k) group |= uint64_t{depth[i + k]} << (8 * k);
        // The high bit of each byte that is 0. No carry leaves a byte.
        uint64_t on_border = ~(((group & kLows) + kLows) | group | kLows);
        for (; on_border != 0; on_border &= on_border - 1) f(i + static_cast<size_t>(std::countr_zero(on_border)) / 8);
    }
    for (; i < count; ++i)
        if (depth[i] == kOnBorder) f(i);
}

}  // namespace

void close_charts(const ChartLevelShape& shape, const ChartWorkspace& ws, float* samples) {
    const auto for_each = [&](const auto& f) {
        for_each_border_sample(ws.depth, static_cast<size_t>(shape.samples), [&](size_t i) { f(i, ws.point[i], i); });
    };
    // `queue` holds the first samples until diffuse needs it.
    const PointWork work = {ws.sums, ws.queue, ws.members};
    if (!average_points(for_each, shape.size.vertices, samples, ws.corrections, work)) return;
    for (uint32_t c = 0; c < shape.chart_count; ++c) {
        const DecodedChart& chart = ws.charts[c];
        const size_t first = size_t{chart.first} * 3;
        spread_corrections({chart.columns, chart.rows, ws.depth + chart.first, ws.corrections + first, samples + first},
                           {chart.border.samples, chart.border.border_length}, ws.queue);
    }
}

}  // namespace gim

#include "decoder/charts/close_charts.h"

#include <cstring>

#include "format/chart_ramp.h"
#include "format/close_seams.h"

namespace gim {
namespace {

// Calls f(i) for every border sample. Most groups of eight have none.
template <class F>
void for_each_border_sample(const uint8_t* depth, size_t count, const F& f) {
    static_assert(kOnBorder == 0);
    constexpr uint64_t kOnes = 0x0101010101010101u, kHighs = 0x8080808080808080u;
    size_t i = 0;
    for (; i + 8 <= count; i += 8) {
        uint64_t group = 0;
        std::memcpy(&group, depth + i, 8);
        if (((group - kOnes) & ~group & kHighs) == 0) continue;  // no byte is 0
        for (size_t k = i; k < i + 8; ++k)
            if (depth[k] == kOnBorder) f(k);
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

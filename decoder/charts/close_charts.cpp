#include "decoder/charts/close_charts.h"

#include "format/chart_ramp.h"
#include "format/close_seams.h"

namespace gim {

void close_charts(const ChartLevelShape& shape, const ChartWorkspace& ws, float* samples) {
    const auto for_each = [&](const auto& f) {
        for (uint32_t i = 0; i < shape.samples; ++i) {
            if (ws.depth[i] == kOnBorder) f(size_t{i}, ws.point[i], size_t{i});
        }
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

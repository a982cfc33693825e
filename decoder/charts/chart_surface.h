// The glued surface of one level of a multi-chart image.  spec/gim-format.md, "Charts".
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 3 (reconstruction): three
// defined samples of a cell make a triangle, four make two. We leave out triangles that zippering made degenerate.
// Normals come from triangles: charts are too ragged for differences along rows and columns.
#pragma once

#include <algorithm>

#include "decoder/charts/chart_decoder.h"

namespace gim {

// Calls f(vertex, chart, column, row, sample) for every vertex, with the place and the flat index of its first sample.
template <class F>
void for_each_chart_vertex(const ChartLevelShape& shape, const ChartWorkspace& ws, const F& f) {
    uint32_t next = 0;
    for (uint32_t c = 0; c < shape.chart_count; ++c) {
        const DecodedChart& chart = ws.charts[c];
        for (uint32_t i = 0; i < chart.columns * chart.rows; ++i) {
            const uint32_t sample = chart.first + i;
            if (ws.depth[sample] == kUndefined || ws.point[sample] != next) continue;
            f(next++, chart, i % chart.columns, i / chart.columns, sample);
        }
    }
}

// Calls f(vertex, sample, count) for all vertices in runs: their first samples follow each other. May run on from chart
// to chart.
template <class F>
void for_each_chart_run(const ChartLevelShape& shape, const ChartWorkspace& ws, const F& f) {
    const auto is_first = [&](size_t sample, uint32_t vertex) {
        return ws.depth[sample] != kUndefined && ws.point[sample] == vertex;
    };
    uint32_t next = 0;
    for (size_t begin = 0, end = 0; begin < shape.samples; begin = std::max(end, begin + 1)) {
        for (end = begin; end < shape.samples && is_first(end, next); ++end) ++next;
        if (end > begin) f(next - static_cast<uint32_t>(end - begin), begin, end - begin);
    }
}

// What to make of the triangles of a level.
struct ChartTriangles {
    const uint32_t* names = nullptr;  // per flat sample: what a corner is called in `triangles`; null: as it is
    uint32_t* triangles = nullptr;    // three names each; may be null
    float* normals = nullptr;         // per vertex: the sum of the triangles' normals by area; may be null
};

// Finds the triangles, whether they are wanted or not. Returns false unless there are as many as the level says; never
// writes more.
bool triangulate_charts(const ChartLevelShape& shape, const ChartWorkspace& ws, const float* samples,
                        const ChartTriangles& out);

}  // namespace gim

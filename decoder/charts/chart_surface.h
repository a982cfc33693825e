// The glued surface of one level of a multi-chart image.  spec/gim-format.md, "Charts".
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 3 (reconstruction): three
// defined samples of a cell make a triangle, four make two. We leave out triangles that zippering made degenerate.
// Normals come from triangles: charts are too ragged for differences along rows and columns.
#pragma once

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

#include "decoder/charts/chart_surface.h"

#include <algorithm>
#include <array>

#include "decoder/pyramid/vector3.h"
#include "format/chart_split.h"

namespace gim {
namespace {

// What chart_split asks of one chart.
struct ChartGrid {
    const uint8_t* depth;
    const uint32_t* points;
    uint32_t columns;

    uint32_t index(uint32_t row, uint32_t column) const { return row * columns + column; }
    bool on_border(uint32_t row, uint32_t column) const { return depth[index(row, column)] == kOnBorder; }
    uint32_t point(uint32_t row, uint32_t column) const { return points[index(row, column)]; }
};

// Collects triangles that have three different points.
struct TriangleSink {
    const uint32_t* point;
    uint32_t* out;
    uint32_t capacity;
    uint32_t count = 0;  // may pass the capacity

    void add(uint32_t a, uint32_t b, uint32_t c) {
        if (point[a] == point[b] || point[b] == point[c] || point[c] == point[a]) return;
        if (count++ >= capacity) return;
        out[0] = a;
        out[1] = b;
        out[2] = c;
        out += 3;
    }
};

void add_cell(const ChartGrid& grid, uint32_t row, uint32_t column, uint32_t first, const float* samples,
              TriangleSink* sink) {
    const uint32_t i = grid.index(row, column);
    const std::array<uint32_t, 4> corner = {i, i + 1, i + grid.columns + 1, i + grid.columns};
    std::array<uint32_t, 4> defined{};
    uint32_t count = 0;
    for (const uint32_t c : corner) {
        if (grid.depth[c] != kUndefined) defined[count++] = first + c;
    }
    if (count == 3) sink->add(defined[0], defined[1], defined[2]);
    if (count < 4) return;
    const Split split = chart_split(grid, row, column);
    const auto [a, b, c, d] = defined;
    const bool main = split == Split::kMain || (split == Split::kShorter &&
                                                squared_distance(samples + size_t{a} * 3, samples + size_t{c} * 3) <=
                                                    squared_distance(samples + size_t{b} * 3, samples + size_t{d} * 3));
    sink->add(a, b, main ? c : d);
    main ? sink->add(a, c, d) : sink->add(b, c, d);
}

}  // namespace

bool triangulate_charts(const ChartLevelShape& shape, const ChartWorkspace& ws, const float* samples,
                        uint32_t* triangles, uint32_t capacity) {
    TriangleSink sink{ws.point, triangles, capacity};
    for (uint32_t c = 0; c < shape.chart_count; ++c) {
        const DecodedChart& chart = ws.charts[c];
        const ChartGrid grid = {ws.depth + chart.first, ws.point + chart.first, chart.columns};
        for (uint32_t row = 0; row + 1 < chart.rows; ++row) {
            for (uint32_t column = 0; column + 1 < chart.columns; ++column)
                add_cell(grid, row, column, chart.first, samples, &sink);
        }
    }
    return sink.count == capacity;
}

void chart_normals(const ChartLevelShape& shape, const ChartWorkspace& ws, const float* samples,
                   const uint32_t* triangles, float* normals) {
    std::fill_n(normals, size_t{shape.size.vertices} * 3, 0.0f);
    for (uint32_t t = 0; t < shape.size.triangles; ++t) {
        const uint32_t* corner = triangles + size_t{t} * 3;
        const float *a = samples + size_t{corner[0]} * 3, *b = samples + size_t{corner[1]} * 3,
                    *c = samples + size_t{corner[2]} * 3;
        float u[3], v[3], n[3];
        for (int k = 0; k < 3; ++k) {
            u[k] = b[k] - a[k];
            v[k] = c[k] - a[k];
        }
        cross(u, v, n);
        for (int i = 0; i < 3; ++i) {
            float* sum = normals + size_t{ws.point[corner[i]]} * 3;
            for (int k = 0; k < 3; ++k) sum[k] = sum[k] + n[k];
        }
    }
    for (uint32_t v = 0; v < shape.size.vertices; ++v) normalize(normals + size_t{v} * 3);
}

}  // namespace gim

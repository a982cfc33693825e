#include "decoder/charts/chart_surface.h"

#include <algorithm>
#include <array>

#include "decoder/pyramid/cells.h"
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

// Counts triangles, writes them and adds up their normals, as far as they are wanted.
class TriangleSink {
  public:
    TriangleSink(const uint32_t* point, const float* samples, uint32_t capacity, const ChartTriangles& out)
        : point_(point), samples_(samples), capacity_(capacity), out_(out) {}

    uint32_t count() const { return count_; }  // may pass the capacity

    // Adds a triangle of flat samples if it has three different points.
    void add(uint32_t a, uint32_t b, uint32_t c) {
        if (point_[a] == point_[b] || point_[b] == point_[c] || point_[c] == point_[a]) return;
        add_proper(a, b, c);
    }
    // Adds one that is known to have them.
    void add_proper(uint32_t a, uint32_t b, uint32_t c) {
        if (count_++ >= capacity_) return;
        if (out_.triangles) {
            out_.triangles[0] = out_.names ? out_.names[a] : a;
            out_.triangles[1] = out_.names ? out_.names[b] : b;
            out_.triangles[2] = out_.names ? out_.names[c] : c;
            out_.triangles += 3;
        }
        if (out_.normals) add_normal({a, b, c});
    }

    // Adds cells of a row in which no two corners are one point. first: the first sample; is_main: how each is split.
    void add_cells(uint32_t first, uint32_t columns, const uint32_t* is_main, uint32_t cells) {
        const bool fits = count_ <= capacity_ && 2 * cells <= capacity_ - count_;
        count_ += 2 * cells;
        if (!fits) return;
        if (out_.triangles) {
            if (out_.names)
                write_cells(out_.names + first, out_.names + first + columns, is_main, cells, out_.triangles);
            else
                write_rising_cells(first, first + columns, is_main, cells, out_.triangles);
            out_.triangles += size_t{6} * cells;
        }
        for (uint32_t i = 0; out_.normals && i < cells; ++i) {
            const uint32_t a = first + i, b = a + 1, c = a + columns, d = c + 1;
            add_normal({a, b, is_main[i] ? d : c});
            add_normal({is_main[i] ? a : b, d, c});
        }
    }

  private:
    void add_normal(const std::array<uint32_t, 3>& corners) {
        const float *a = samples_ + size_t{corners[0]} * 3, *b = samples_ + size_t{corners[1]} * 3,
                    *c = samples_ + size_t{corners[2]} * 3;
        float u[3], v[3], n[3];
        for (int k = 0; k < 3; ++k) {
            u[k] = b[k] - a[k];
            v[k] = c[k] - a[k];
        }
        cross(u, v, n);
        for (const uint32_t corner : corners) {
            float* sum = out_.normals + size_t{point_[corner]} * 3;
            for (int k = 0; k < 3; ++k) sum[k] = sum[k] + n[k];
        }
    }

    const uint32_t* point_;
    const float* samples_;
    uint32_t capacity_, count_ = 0;
    ChartTriangles out_;
};

bool main_is_shorter(const float* samples, const std::array<uint32_t, 4>& corners) {
    const auto [a, b, c, d] = corners;
    return squared_distance(samples + size_t{a} * 3, samples + size_t{c} * 3) <=
           squared_distance(samples + size_t{b} * 3, samples + size_t{d} * 3);
}

// A cell with a sample on the border, or with undefined ones.
void add_border_cell(const ChartGrid& grid, uint32_t row, uint32_t column, uint32_t first, const float* samples,
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
    const bool main = split == Split::kMain || (split == Split::kShorter && main_is_shorter(samples, defined));
    sink->add(a, b, main ? c : d);
    main ? sink->add(a, c, d) : sink->add(b, c, d);
}

// Cells of a row whose samples are all inside: no two corners of one are one point. first: the first sample.
void add_inner_cells(uint32_t first, uint32_t columns, uint32_t cells, const float* samples, TriangleSink* sink) {
    constexpr uint32_t kCells = 64;
    float upper[3 * (kCells + 1)], lower[3 * (kCells + 1)];
    uint32_t is_main[kCells];
    for (uint32_t done = 0; done < cells; done += kCells) {
        const uint32_t count = std::min(cells - done, kCells), i = first + done;
        split_row(samples + size_t{i} * 3, count + 1, upper);
        split_row(samples + size_t{i + columns} * 3, count + 1, lower);
        find_shorter_main(upper, lower, count + 1, is_main);
        sink->add_cells(i, columns, is_main, count);
    }
}

bool is_inside(uint8_t depth) { return depth != kOnBorder && depth != kUndefined; }

}  // namespace

bool triangulate_charts(const ChartLevelShape& shape, const ChartWorkspace& ws, const float* samples,
                        const ChartTriangles& out) {
    if (out.normals) std::fill_n(out.normals, size_t{shape.size.vertices} * 3, 0.0f);
    TriangleSink sink(ws.point, samples, shape.size.triangles, out);
    for (uint32_t c = 0; c < shape.chart_count; ++c) {
        const DecodedChart& chart = ws.charts[c];
        const ChartGrid grid = {ws.depth + chart.first, ws.point + chart.first, chart.columns};
        for (uint32_t row = 0; row + 1 < chart.rows; ++row) {
            const uint8_t *upper = grid.depth + size_t{row} * chart.columns, *lower = upper + chart.columns;
            for (uint32_t column = 0; column + 1 < chart.columns;) {
                static_assert(kUndefined == UINT8_MAX);
                if ((upper[column] & upper[column + 1] & lower[column] & lower[column + 1]) == kUndefined) {
                    ++column;
                    continue;
                }
                const uint32_t begin = column;  // of samples that are inside in both rows
                while (column < chart.columns && is_inside(upper[column]) && is_inside(lower[column])) ++column;
                if (column - begin > 1)
                    add_inner_cells(chart.first + grid.index(row, begin), chart.columns, column - begin - 1, samples,
                                    &sink);
                if (column > begin) --column;  // the last of them begins a cell of the border, if any
                if (column + 1 < chart.columns) add_border_cell(grid, row, column, chart.first, samples, &sink);
                ++column;
            }
        }
    }
    for (uint32_t v = 0; out.normals && v < shape.size.vertices; ++v) normalize(out.normals + size_t{v} * 3);
    return sink.count() == shape.size.triangles;
}

}  // namespace gim

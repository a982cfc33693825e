#include "encoder/raster/raster_surface.h"

#include <algorithm>
#include <array>

#include "decoder/pyramid/vector3.h"
#include "format/chart_ramp.h"
#include "format/chart_split.h"

namespace gim {
namespace {

// What chart_split asks.
struct Grid {
    const RasterGluing& gluing;
    uint32_t width;

    uint32_t index(uint32_t row, uint32_t column) const { return row * width + column; }
    bool on_border(uint32_t row, uint32_t column) const { return gluing.depth[index(row, column)] == kOnBorder; }
    uint32_t point(uint32_t row, uint32_t column) const { return gluing.point[index(row, column)]; }
};

CellKind cell_kind(const Grid& grid, uint32_t row, uint32_t column) {
    const uint32_t i = grid.index(row, column);
    const std::array<uint32_t, 4> corners = {i, i + 1, i + grid.width + 1, i + grid.width};
    constexpr CellKind kWithout[] = {CellKind::kNoFirst, CellKind::kNoSecond, CellKind::kNoThird, CellKind::kNoFourth};
    uint32_t count = 0;
    CellKind without = CellKind::kEmpty;
    for (size_t k = 0; k < 4; ++k) {
        const bool is_defined = grid.gluing.depth[corners[k]] != kUndefined;
        count += is_defined ? 1 : 0;
        if (!is_defined) without = kWithout[k];
    }
    if (count == 4) return kind_of(chart_split(grid, row, column));
    return count == 3 ? without : CellKind::kEmpty;
}

}  // namespace

std::vector<CellKind> raster_cells(const RasterGluing& gluing, uint32_t width, uint32_t height) {
    const Grid grid = {gluing, width};
    std::vector<CellKind> kinds;
    for (uint32_t row = 0; row + 1 < height; ++row) {
        for (uint32_t column = 0; column + 1 < width; ++column) kinds.push_back(cell_kind(grid, row, column));
    }
    return kinds;
}

std::vector<Triangle> raster_triangles(const RasterGluing& gluing, uint32_t width, uint32_t height,
                                       std::span<const float> units) {
    const Grid grid = {gluing, width};
    const auto distance = [&](uint32_t a, uint32_t b) {
        return squared_distance(&units[size_t{a} * 3], &units[size_t{b} * 3]);
    };
    std::vector<Triangle> triangles;
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
        const auto& point = gluing.point;
        if (point[a] != point[b] && point[b] != point[c] && point[c] != point[a]) triangles.push_back({a, b, c});
    };
    for (uint32_t row = 0; row + 1 < height; ++row) {
        for (uint32_t column = 0; column + 1 < width; ++column) {
            const uint32_t i = grid.index(row, column);
            const uint32_t a = i, b = i + 1, c = i + width + 1, d = i + width;
            switch (const CellKind kind = cell_kind(grid, row, column)) {
                case CellKind::kEmpty:
                    break;
                case CellKind::kNoFirst:
                    add(b, c, d);
                    break;
                case CellKind::kNoSecond:
                    add(a, c, d);
                    break;
                case CellKind::kNoThird:
                    add(a, b, d);
                    break;
                case CellKind::kNoFourth:
                    add(a, b, c);
                    break;
                default:
                    if (kind == CellKind::kMain || (kind == CellKind::kShorter && distance(a, c) <= distance(b, d))) {
                        add(a, b, c);
                        add(a, c, d);
                    } else {
                        add(a, b, d);
                        add(b, c, d);
                    }
            }
        }
    }
    return triangles;
}

void open_crowded_edges(uint32_t width, uint32_t height, std::span<const float> units, RasterGluing& gluing) {
    constexpr int kRounds = 8;
    struct Edge {
        std::array<uint32_t, 2> points, samples;
    };
    for (int round = 0; round < kRounds; ++round) {
        std::vector<Edge> edges;
        for (const Triangle& t : raster_triangles(gluing, width, height, units)) {
            for (size_t k = 0; k < 3; ++k) {
                const uint32_t a = t[k], b = t[(k + 1) % 3];
                if (!gluing.is_shared[a] || !gluing.is_shared[b]) continue;
                const auto [low, high] = std::minmax(gluing.point[a], gluing.point[b]);
                edges.push_back({{low, high}, {a, b}});
            }
        }
        std::stable_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.points < b.points; });
        bool is_changed = false;
        for (size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
            while (end < edges.size() && edges[end].points == edges[begin].points) ++end;
            if (end - begin <= 2) continue;
            for (size_t i = begin; i < end; ++i) {
                for (const uint32_t sample : edges[i].samples) {
                    is_changed = is_changed || gluing.origin[sample] != sample;
                    gluing.origin[sample] = sample;
                }
            }
        }
        if (!is_changed) return;
        number_points(gluing);
    }
}

Mesh raster_surface(const RasterGluing& gluing, std::span<const Triangle> triangles,
                    const std::vector<Vec3>& positions) {
    Mesh mesh;
    for (uint32_t i = 0; i < positions.size(); ++i) {
        if (gluing.depth[i] != kUndefined && gluing.origin[i] == i) mesh.positions.push_back(positions[i]);
    }
    for (const Triangle& t : triangles)
        mesh.triangles.push_back({gluing.point[t[0]], gluing.point[t[1]], gluing.point[t[2]]});
    return mesh;
}

}  // namespace gim

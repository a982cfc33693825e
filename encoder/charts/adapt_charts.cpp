#include "encoder/charts/adapt_charts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/charts/chart_sample.h"
#include "encoder/surface/closest_point.h"

namespace gim {

namespace {

// Samples the charts side by side and returns the triangles.
Mesh sample_side_by_side(const Atlas& atlas, double scale) {
    Packing row;
    row.scale = scale;
    for (size_t c = 0; c < atlas.charts.size(); ++c) {
        const std::vector<Vec2> border = border_of(atlas.charts[c], atlas.maps[c].uv);
        PlacedChart placed{rasterize_chart(border, scale, 0), row.width, 0};
        placed.chart.pose.offset += Vec2(row.width, 0);
        row.width += placed.chart.mask.width + 1;
        row.height = std::max(row.height, placed.chart.mask.height);
        row.charts.push_back(std::move(placed));
    }
    return samples_as_mesh(sample_charts(atlas.charts, atlas.maps, row));
}

// Returns the distance of each vertex to the charts sampled side by side. Empty if they make no triangle.
std::vector<ClosestPoint> distances_of(const Mesh& mesh, const Atlas& atlas, uint32_t samples) {
    double area = 0;
    for (const ChartMap& map : atlas.maps) area += map.area;
    const Mesh sampled = sample_side_by_side(atlas, std::sqrt(samples / area));
    if (sampled.triangles.empty()) return {};
    return ClosestPointTree(sampled).find_all(mesh.positions);
}

VertexAreas vertex_areas(const Mesh& mesh, const Atlas& atlas) {
    VertexAreas areas{std::vector<double>(mesh.positions.size(), 0.0), std::vector<double>(mesh.positions.size(), 0.0)};
    for (size_t c = 0; c < atlas.charts.size(); ++c) {
        const VertexAreas own = vertex_areas(atlas.charts[c].mesh, atlas.maps[c].uv);
        for (size_t v = 0; v < own.surface.size(); ++v) {
            areas.surface[atlas.charts[c].source_vertex[v]] += own.surface[v];
            areas.square[atlas.charts[c].source_vertex[v]] += own.square[v];
        }
    }
    return areas;
}

}  // namespace

Result<std::vector<double>> adapt_charts(const Mesh& mesh, uint32_t samples, const DensityOptions& options,
                                         const ChartParametrizeOptions& parametrize, Atlas& atlas,
                                         const Progress& progress) {
    const VertexAreas areas = vertex_areas(mesh, atlas);
    const std::vector<ClosestPoint> even = distances_of(mesh, atlas, samples);
    if (even.empty()) return std::vector<double>{};
    const std::vector<double> at_vertex = importance_of(mesh, areas, even, options);
    if (at_vertex.empty()) return std::vector<double>{};
    std::vector<double> importance;
    for (const Triangle& t : mesh.triangles)
        importance.push_back((at_vertex[t[0]] + at_vertex[t[1]] + at_vertex[t[2]]) / 3);

    Atlas adapted = atlas;
    GIM_TRY(maps, parametrize_charts(atlas.charts, importance, parametrize, progress));
    for (size_t c = 0; c < maps.size(); ++c) {
        if (!maps[c].overlaps) {
            adapted.maps[c] = std::move(maps[c]);
            continue;
        }
        // The chart keeps its shape, but its size is that of an important chart.
        measure_map(atlas.charts[c], atlas.charts[c].of_own_faces(importance), adapted.maps[c]);
        scale_best(adapted.maps[c]);
    }
    const std::vector<ClosestPoint> now = distances_of(mesh, adapted, samples);
    const auto error = [&](const std::vector<ClosestPoint>& closest) {
        double sum = 0;
        for (size_t v = 0; v < closest.size(); ++v) sum += areas.surface[v] * closest[v].squared_distance;
        return sum;
    };
    if (now.empty() || error(now) >= error(even)) return std::vector<double>{};
    atlas = std::move(adapted);
    return importance;
}

}  // namespace gim

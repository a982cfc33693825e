#include "encoder/image/density.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "encoder/base/result.h"
#include "encoder/charts/chart_sample.h"
#include "encoder/image/gluing.h"
#include "encoder/surface/closest_point.h"
#include "encoder/surface/stretch.h"

namespace gim {

namespace {

// Twice the area around each vertex, on the surface and in the square.
struct VertexAreas {
    std::vector<double> surface, square;
};

VertexAreas vertex_areas(const Mesh& mesh, const std::vector<Vec2>& uv) {
    VertexAreas areas{std::vector<double>(uv.size(), 0.0), std::vector<double>(uv.size(), 0.0)};
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        for (const uint32_t v : t) {
            areas.surface[v] += 2 * face_area(mesh, f);
            areas.square[v] += twice_signed_area(uv[t[0]], uv[t[1]], uv[t[2]]);
        }
    }
    return areas;
}

// Area-weighted mean over the vertices of all faces around each vertex.
std::vector<double> average_neighbours(const Mesh& mesh, const std::vector<double>& area,
                                       const std::vector<double>& value) {
    std::vector<double> sum(value.size(), 0.0), weight(value.size(), 0.0);
    for (const Triangle& t : mesh.triangles) {
        double face_sum = 0, face_weight = 0;
        for (const uint32_t v : t) face_sum += area[v] * value[v], face_weight += area[v];
        for (const uint32_t v : t) sum[v] += face_sum, weight[v] += face_weight;
    }
    for (size_t v = 0; v < sum.size(); ++v) sum[v] = weight[v] > 0 ? sum[v] / weight[v] : value[v];
    return sum;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Per vertex, from the squared distance of each to a surface sampled with densities square / surface: C = e^2 * density^2,
// smoothed, as a vertex that happens to lie on a sample says nothing by itself. Empty where there is no error.
std::vector<double> importance_of(const Mesh& mesh, const VertexAreas& areas, const std::vector<ClosestPoint>& closest,
                                  const DensityOptions& options) {
    std::vector<double> need(closest.size());
    for (size_t v = 0; v < need.size(); ++v) {
        const double density = areas.surface[v] > 0 ? areas.square[v] / areas.surface[v] : 0;
        need[v] = closest[v].squared_distance * density * density;
    }
    for (int i = 0; i < options.smoothing; ++i) need = average_neighbours(mesh, areas.surface, need);
    const double middle = median(need);
    if (!(middle > 0)) return {};
    for (double& n : need) {
        n = std::pow(std::clamp(n / middle, 1 / options.contrast, options.contrast), options.strength * 2 / 3);
    }
    return need;
}

// The charts sampled side by side, as triangles.
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
    const MultiChartImage image = sample_charts(atlas.charts, atlas.maps, row);
    GridGluing apart;
    apart.width = row.width;
    apart.height = row.height;
    apart.representative.assign(image.mask.defined.size(), kNone);
    for (uint32_t v = 0; v < image.mask.defined.size(); ++v) {
        if (image.mask.defined[v]) apart.representative[v] = v;
    }
    apart.kind = classify_cells(image.mask, apart.representative);
    return {image.positions, triangulate_grid(image.positions, apart).triangles};
}

// Of the vertices to the charts sampled side by side; empty where those make no triangle.
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

std::vector<double> importance_from_error(const Mesh& mesh, const std::vector<Vec2>& uv, const GeometryImage& image,
                                          const DensityOptions& options) {
    auto gluing = glue_ring(image.sideband, image.side);
    if (!gluing.ok()) return {};
    const Mesh surface{image.positions, triangulate_grid(image.positions, gluing.value()).triangles};
    const std::vector<ClosestPoint> closest = ClosestPointTree(surface).find_all(mesh.positions);
    return importance_of(mesh, vertex_areas(mesh, uv), closest, options);
}

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
        if (!maps[c].overlaps) adapted.maps[c] = std::move(maps[c]);
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

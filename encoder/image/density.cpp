#include "encoder/image/density.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "encoder/surface/closest_point.h"
#include "encoder/surface/stretch.h"

namespace gim {

namespace {

// Returns for each vertex the area-weighted mean over the vertices of all faces around it.
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

}  // namespace

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

// The need of a vertex is C = e^2 * density^2. Smoothing makes up for vertices that happen to lie on a sample.
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

std::vector<double> importance_from_error(const Mesh& mesh, const std::vector<Vec2>& uv, const GeometryImage& image,
                                          const DensityOptions& options) {
    const std::vector<ClosestPoint> closest = ClosestPointTree(samples_as_mesh(image)).find_all(mesh.positions);
    return importance_of(mesh, vertex_areas(mesh, uv), closest, options);
}

}  // namespace gim

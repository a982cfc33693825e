#include "encoder/raster/fit_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "encoder/fit/fitter.h"
#include "encoder/fit/measure_start.h"
#include "encoder/raster/raster_surface.h"
#include "format/chart_ramp.h"

namespace gim {
namespace {

GeometryImage geometry_image(const RasterImage& image, const RasterGluing& gluing, std::vector<Vec3> positions) {
    GluedSamples samples;
    samples.width = image.width;
    samples.height = image.height;
    samples.defined = image.defined;
    samples.on_input_boundary.assign(positions.size(), false);
    samples.classes.resize(gluing.points);
    for (uint32_t i = 0; i < positions.size(); ++i) {
        if (gluing.is_shared[i]) samples.classes[gluing.point[i]].push_back(i);
    }
    samples.kind = raster_cells(gluing, image.width, image.height);
    return {std::move(positions), make_gluing(std::move(samples))};
}

// Per point: the length of the longest edge there on the boundary of the image's surface; 0: there is none.
std::vector<double> boundary_spacing(const GeometryImage& image, const RasterGluing& gluing) {
    struct Edge {
        std::array<uint32_t, 2> points;
        double length;
    };
    std::vector<Edge> edges;
    for (const Triangle& t : triangulate_grid(image.positions, image.gluing).triangles) {
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = t[k], b = t[(k + 1) % 3];
            const auto [low, high] = std::minmax(gluing.point[a], gluing.point[b]);
            edges.push_back({{low, high}, (image.positions[a] - image.positions[b]).norm()});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.points < b.points; });
    std::vector<double> spacing(gluing.points, 0.0);
    for (size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        while (end < edges.size() && edges[end].points == edges[begin].points) ++end;
        if (end - begin > 1) continue;
        for (const uint32_t point : edges[begin].points) spacing[point] = std::max(spacing[point], edges[begin].length);
    }
    return spacing;
}

// Decides what becomes of the samples on the border of the image's surface. Returns those that stay still.
std::vector<bool> settle_borders(const RasterGluing& gluing, const Mesh& mesh, GeometryImage& image) {
    const std::vector<double> spacing = boundary_spacing(image, gluing);
    const Mesh curve = boundary_curve(mesh);
    const ClosestPointTree surface_tree(mesh), curve_tree(curve);
    std::vector<bool> still(image.positions.size(), false);
    for (uint32_t i = 0; i < still.size(); ++i) {
        if (gluing.depth[i] == kUndefined || spacing[gluing.point[i]] == 0) continue;
        Vec3& place = image.positions[i];
        if (const uint32_t first = gluing.origin[i]; first != i) {
            place = image.positions[first];
            still[i] = still[first];
            image.gluing.on_input_boundary[i] = image.gluing.on_input_boundary[first];
            continue;
        }
        if (!curve.triangles.empty()) {
            const ClosestPoint at = curve_tree.find(place);
            if (at.squared_distance <= spacing[gluing.point[i]] * spacing[gluing.point[i]]) {
                place = at.point;
                image.gluing.on_input_boundary[i] = true;
                continue;
            }
        }
        place = surface_tree.find(place).point;
        still[i] = true;
    }
    return still;
}

std::array<double, 2> range_of(SampleType type) {
    switch (type) {
        case SampleType::kUint8:
            return {0, 0xFF};
        case SampleType::kInt8:
            return {-0x80, 0x7F};
        case SampleType::kUint16:
            return {0, 0xFFFF};
        case SampleType::kInt16:
            return {-0x8000, 0x7FFF};
        case SampleType::kUint32:
            return {0, 0xFFFFFFFF};
        case SampleType::kInt32:
            return {-0x80000000LL, 0x7FFFFFFF};
        default:
            return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    }
}

void place_samples(const std::vector<Vec3>& positions, RasterImage& image) {
    const auto [low, high] = range_of(image.type);
    for (size_t i = 0; i < positions.size(); ++i) {
        if (!image.defined[i]) continue;
        for (size_t k = 0; k < 3; ++k) {
            const double value = positions[i][static_cast<int>(k)];
            image.values[i * image.channels + k] =
                is_whole(image.type) ? std::clamp(std::round(value), low, high) : value;
        }
    }
}

}  // namespace

Result<FittedRaster> fit_raster(const RasterImage& image, const RasterGluing& gluing,
                                const std::vector<Vec3>& positions, const Mesh& mesh, const FitOptions& options,
                                const Progress& progress) {
    GeometryImage start = geometry_image(image, gluing, positions);
    GIM_TRY(quality, measure_start(start, mesh, options.threads));
    FitOptions now = options;
    now.still = settle_borders(gluing, mesh, start);
    GIM_TRY(fitted, fit(start, mesh, now, progress));
    FittedRaster result{image, quality, fitted.after};
    place_samples(fitted.positions, result.image);
    return result;
}

}  // namespace gim

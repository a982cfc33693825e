#include "encoder/charts/chart_slits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

#include "encoder/surface/closest_point.h"
#include "encoder/surface/refine.h"
#include "encoder/surface/stretch.h"

namespace gim {

namespace {

constexpr double kNarrow = 1.2;  // in samples; masks fill gaps narrower than this
constexpr double kApart = 5;     // in samples of an even map; triangles longer than this are visible
constexpr double kStep = 0.5;    // in samples, between the border points that are looked at

struct BorderPoint {
    Vec2 map;
    Vec3 surface;
    Vec2 outward;
    uint32_t face = 0;
};

std::vector<BorderPoint> border_points(const Chart& chart, const ChartMap& map, double step) {
    const auto key = [](uint32_t a, uint32_t b) { return uint64_t{a} << 32 | b; };
    std::unordered_map<uint64_t, uint32_t> face_of;
    for (uint32_t f = 0; f < chart.mesh.triangles.size(); ++f) {
        const Triangle& t = chart.mesh.triangles[f];
        for (size_t k = 0; k < 3; ++k) face_of[key(t[k], t[(k + 1) % 3])] = f;
    }
    std::vector<BorderPoint> points;
    for (size_t k = 0; k < chart.loop.size(); ++k) {
        const uint32_t v = chart.loop[k], w = chart.loop[(k + 1) % chart.loop.size()];
        const Vec2 edge = map.uv[w] - map.uv[v];
        const double length = edge.norm();
        if (!(length > 0)) continue;
        const auto count = static_cast<int>(std::ceil(length / step));
        for (int i = 0; i < count; ++i) {
            const double t = (i + 0.5) / count;
            points.push_back({map.uv[v] + t * edge, (1 - t) * chart.mesh.positions[v] + t * chart.mesh.positions[w],
                              Vec2(edge.y(), -edge.x()) / length, face_of.at(key(v, w))});
        }
    }
    return points;
}

// Finds the two border points that are farthest apart on the surface among those close together across a narrow gap.
// Returns the faces beside them. Empty if no gap is narrow.
std::optional<std::array<uint32_t, 2>> worst_slit(const Chart& chart, const ChartMap& map, double spacing) {
    std::vector<BorderPoint> points = border_points(chart, map, kStep * spacing);
    std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.map.x() < b.map.x(); });
    std::optional<std::array<uint32_t, 2>> worst;
    double farthest = kApart * spacing;
    for (size_t i = 0; i < points.size(); ++i) {
        const BorderPoint& p = points[i];
        for (size_t j = i + 1; j < points.size() && points[j].map.x() - p.map.x() < kNarrow * spacing; ++j) {
            const BorderPoint& q = points[j];
            const Vec2 gap = q.map - p.map;
            if (gap.norm() >= kNarrow * spacing || gap.dot(p.outward) <= 0 || gap.dot(q.outward) >= 0) continue;
            const double apart = (q.surface - p.surface).norm();
            if (apart <= farthest || p.face == q.face) continue;
            farthest = apart;
            worst = std::array{p.face, q.face};
        }
    }
    return worst;
}

}  // namespace

std::vector<uint32_t> find_slits(double spacing, Atlas& atlas) {
    std::vector<uint32_t> found;
    for (uint32_t c = 0; c < atlas.charts.size(); ++c) {
        if (const auto slit = worst_slit(atlas.charts[c], atlas.maps[c], spacing)) {
            atlas.maps[c].crossing = slit;
            found.push_back(c);
        }
    }
    return found;
}

namespace {

// Finds the face of a chart whose middle is nearest to a point.
uint32_t nearest_face(const Chart& chart, const Vec3& point) {
    uint32_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (uint32_t f = 0; f < chart.mesh.triangles.size(); ++f) {
        const auto& [a, b, c] = chart.mesh.triangles[f];
        const Vec3 middle = (chart.mesh.positions[a] + chart.mesh.positions[b] + chart.mesh.positions[c]) / 3;
        if ((middle - point).squaredNorm() >= least) continue;
        least = (middle - point).squaredNorm();
        nearest = f;
    }
    return nearest;
}

}  // namespace

std::vector<uint32_t> find_bridges(const MultiChartImage& image, const Packing& packing, const Mesh& surface,
                                   Atlas& atlas) {
    constexpr double kLongEdge = 4, kOffSurface = 1;  // in spacings
    const std::vector<uint32_t> owner = owners_of(packing);
    const double spacing = std::sqrt(surface_area(surface) / static_cast<double>(image.mask.count()));
    const ClosestPointTree tree(surface);
    std::vector<double> worst(atlas.charts.size(), 0.0);
    std::vector<uint32_t> bridged;
    const auto look_at = [&](const Triangle& t) {
        size_t longest = 0;
        double length = 0;
        for (size_t k = 0; k < 3; ++k) {
            const double here = (image.positions[t[k]] - image.positions[t[(k + 1) % 3]]).norm();
            if (here > length) length = here, longest = k;
        }
        const uint32_t c = owner[t[0]];
        if (length <= std::max(kLongEdge * spacing, worst[c])) return;
        const Vec3 &a = image.positions[t[longest]], &b = image.positions[t[(longest + 1) % 3]];
        if (tree.find(0.5 * (a + b)).squared_distance <= kOffSurface * kOffSurface * spacing * spacing) return;
        const Chart& chart = atlas.charts[c];
        const uint32_t first = nearest_face(chart, a), second = nearest_face(chart, b);
        if (first == second) return;
        if (worst[c] == 0) bridged.push_back(c);
        worst[c] = length;
        atlas.maps[c].crossing = {first, second};
    };
    for (uint32_t cell = 0; cell < image.gluing.kind.size(); ++cell) {
        const CellTriangles all = cell_triangles(image.positions, image.gluing, cell);
        for (uint32_t k = 0; k < all.count; ++k) look_at(all.triangles[k]);
    }
    std::sort(bridged.begin(), bridged.end());
    return bridged;
}

}  // namespace gim

#include "encoder/chart_slits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "encoder/stretch.h"

namespace gim {

namespace {

constexpr double kNarrow = 1.2;  // in samples: what masks fill
constexpr double kApart = 5;     // in samples of an even map: longer triangles than this are visible
constexpr double kStep = 0.5;    // in samples, between the points of a border that are looked at

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

// The faces beside the two border points that a narrow gap brings together although they are farthest apart.
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

}  // namespace gim

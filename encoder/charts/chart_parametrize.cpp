#include "encoder/charts/chart_parametrize.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "encoder/base/parallel.h"
#include "encoder/base/result.h"
#include "encoder/charts/chart_energy.h"
#include "encoder/charts/chart_newton.h"
#include "encoder/surface/stretch.h"
#include "encoder/surface/tutte.h"

namespace gim {

namespace {

constexpr int kBarrierSteps = 60;  // most Newton steps with a barrier

// ---- start --------------------------------------------------------------------------------------------------------

bool all_upright(const Mesh& mesh, const std::vector<Vec2>& uv) {
    return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
        const double longest = std::max({(uv[t[1]] - uv[t[0]]).squaredNorm(), (uv[t[2]] - uv[t[1]]).squaredNorm(),
                                         (uv[t[0]] - uv[t[2]]).squaredNorm()});
        return twice_signed_area(uv[t[0]], uv[t[1]], uv[t[2]]) > 1e-3 * longest;
    });
}

std::vector<Vec2> projected(const Mesh& mesh) {
    Vec3 normal = Vec3::Zero();
    for (const Triangle& t : mesh.triangles)
        normal += (mesh.positions[t[1]] - mesh.positions[t[0]]).cross(mesh.positions[t[2]] - mesh.positions[t[0]]);
    if (!(normal.norm() > 0)) normal = Vec3::UnitZ();
    normal.normalize();
    const Vec3 x = normal.unitOrthogonal(), y = normal.cross(x);
    std::vector<Vec2> uv;
    uv.reserve(mesh.positions.size());
    for (const Vec3& p : mesh.positions) uv.emplace_back(x.dot(p), y.dot(p));
    return uv;
}

// Computes Tutte's map to a circle. It is injective on any disk, because no three border vertices lie on a line.
bool tutte(const Chart& chart, double total_area, std::vector<Vec2>& uv) {
    const Mesh& mesh = chart.mesh;
    const double radius = std::sqrt(total_area / std::numbers::pi);
    uv.assign(mesh.positions.size(), Vec2::Zero());
    std::vector<uint8_t> fixed(uv.size(), 0);
    std::vector<double> along(chart.loop.size() + 1, 0);
    for (size_t i = 0; i < chart.loop.size(); ++i) {
        const Vec3& a = mesh.positions[chart.loop[i]];
        const Vec3& b = mesh.positions[chart.loop[(i + 1) % chart.loop.size()]];
        along[i + 1] = along[i] + (b - a).norm();
    }
    constexpr double kUniform = 0.05;  // keeps coincident neighbours apart
    for (size_t i = 0; i < chart.loop.size(); ++i) {
        const double even = static_cast<double>(i) / static_cast<double>(chart.loop.size());
        const double part = along.back() > 0 ? (1 - kUniform) * along[i] / along.back() + kUniform * even : even;
        uv[chart.loop[i]] = radius * Vec2(std::cos(2 * std::numbers::pi * part), std::sin(2 * std::numbers::pi * part));
        fixed[chart.loop[i]] = 1;
    }
    // All edges of an interior vertex leave it as half-edges.
    std::vector<std::array<uint32_t, 2>> arcs;
    for (const Triangle& t : mesh.triangles) {
        for (size_t i = 0; i < 3; ++i) arcs.push_back({t[i], t[(i + 1) % 3]});
    }
    return solve_tutte(arcs, fixed, uv);
}

void measure_map(const Mesh& mesh, const std::vector<MapElement>& elements, ChartMap& map) {
    map.energy = map.area = 0;
    for (size_t f = 0; f < elements.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        const double area = twice_signed_area(map.uv[t[0]], map.uv[t[1]], map.uv[t[2]]) / 2;
        map.area += area;
        map.energy += energy(elements[f], jacobian(elements[f], map.uv[t[0]], map.uv[t[1]], map.uv[t[2]])) - area;
    }
}

}  // namespace

std::vector<Vec2> border_of(const Chart& chart, const std::vector<Vec2>& uv) {
    std::vector<Vec2> border;
    border.reserve(chart.loop.size());
    for (const uint32_t v : chart.loop) border.push_back(uv[v]);
    return border;
}

void measure_map(const Chart& chart, const std::vector<double>& importance, ChartMap& map) {
    measure_map(chart.mesh, elements_of(chart.mesh, importance), map);
}

void scale_best(ChartMap& map) {
    const double scale = std::pow(map.energy / map.area, 0.25);
    if (!std::isfinite(scale) || !(scale > 0)) return;
    for (Vec2& p : map.uv) p *= scale;
    map.energy /= scale * scale, map.area *= scale * scale;
}

ChartMap relax_chart(const Chart& chart, const std::vector<double>& importance, ChartMap map, double area_weight,
                     const BorderForce& force, const ChartParametrizeOptions& options) {
    const std::vector<MapElement> elements = elements_of(chart.mesh, importance);
    // Less weight on the area is the same as more weight on the rest.
    std::vector<MapElement> pressed = elements;
    for (MapElement& e : pressed) e.importance /= area_weight;
    minimise_energy(chart.mesh, pressed, &force, {options.most_steps, options.tolerance}, map.uv);
    measure_map(chart.mesh, elements, map);
    return map;
}

Result<ChartMap> parametrize_chart(const Chart& chart, const std::vector<double>& importance,
                                   const ChartParametrizeOptions& options) {
    const Mesh& mesh = chart.mesh;
    std::vector<MapElement> elements = elements_of(mesh, importance);
    double total_area = 0;
    for (const MapElement& e : elements) total_area += e.area;
    ChartMap map;
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) map.surface += face_area(mesh, f);
    const auto border_crossing = [&] { return find_crossing(border_of(chart, map.uv)); };
    const auto measure = [&] { measure_map(mesh, elements, map); };
    const auto start_from_circle = [&] { return tutte(chart, total_area, map.uv); };
    const Error unsolvable{Stage::kParametrize, "a chart of " + std::to_string(mesh.triangles.size()) +
                                                    " triangles could not be flattened; is it a disk?"};
    map.uv = projected(mesh);
    if (!all_upright(mesh, map.uv) && !start_from_circle()) return unsolvable;
    minimise_energy(mesh, elements, nullptr, {options.most_steps, options.tolerance}, map.uv);
    measure();
    if (const auto crossing = border_crossing()) {
        const auto face_at = [&](uint32_t edge) {
            const uint32_t v = chart.loop[edge], w = chart.loop[(edge + 1) % chart.loop.size()];
            const auto found = std::find_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
                return (t[0] == v && t[1] == w) || (t[1] == v && t[2] == w) || (t[2] == v && t[0] == w);
            });
            return static_cast<uint32_t>(found - mesh.triangles.begin());
        };
        map.crossing = std::array{face_at((*crossing)[0]), face_at((*crossing)[1])};
        const double overlapping = map.energy * map.area;
        // Solve again from a map without overlap, with a barrier that keeps the border from meeting itself.
        if (!start_from_circle()) return unsolvable;
        const BorderBarrier barrier(chart, total_area / static_cast<double>(mesh.triangles.size()));
        // The energy is at best twice sqrt(E A). A strain of 1.5 has 1.2 times as much.
        minimise_energy(mesh, elements, &barrier,
                        {std::min(options.most_steps, kBarrierSteps), options.tolerance, 2.5 * std::sqrt(overlapping)},
                        map.uv);
        measure();
        map.strain = std::max(1.0, map.energy * map.area / overlapping);
        map.overlaps = border_crossing().has_value();
    }
    scale_best(map);  // Newton may have stopped a little early
    uint64_t flipped = 0;
    for (const Triangle& t : mesh.triangles)
        flipped += !(twice_signed_area(map.uv[t[0]], map.uv[t[1]], map.uv[t[2]]) > 0);
    if (flipped > 0) map.overlaps = true;
    return map;
}

Result<std::vector<ChartMap>> parametrize_charts(const std::vector<Chart>& charts,
                                                 const std::vector<double>& importance,
                                                 const ChartParametrizeOptions& options, const Progress& progress) {
    std::vector<ChartMap> maps(charts.size());
    std::vector<std::string> errors(charts.size());
    if (progress) progress(Stage::kParametrize, 0);
    parallel_blocks(charts.size(), 1, options.threads, [&](size_t, size_t begin, size_t end) {
        for (size_t c = begin; c < end; ++c) {
            auto map = parametrize_chart(charts[c], charts[c].of_own_faces(importance), options);
            if (map.ok()) {
                maps[c] = std::move(map.value());
            } else {
                errors[c] = map.error().message;
            }
        }
    });
    for (size_t c = 0; c < errors.size(); ++c) {
        if (!errors[c].empty()) return Error{Stage::kParametrize, "chart " + std::to_string(c) + ": " + errors[c]};
    }
    return maps;
}

double stretch_efficiency(const std::vector<Chart>& charts, const std::vector<ChartMap>& maps) {
    double energy_sum = 0, area = 0, domain = 0;
    for (size_t c = 0; c < charts.size(); ++c) {
        const Mesh& mesh = charts[c].mesh;
        const std::vector<Vec2>& uv = maps[c].uv;
        for (const Triangle& t : mesh.triangles) {
            domain += twice_signed_area(uv[t[0]], uv[t[1]], uv[t[2]]) / 2;
            const FaceMetric metric = face_metric(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], 0);
            if (metric.weight == 0) continue;
            energy_sum += stretch_energy(metric, uv[t[0]], uv[t[1]], uv[t[2]]);
            area += 2 * metric.weight;
        }
    }
    return area * area / (domain * energy_sum);
}

}  // namespace gim

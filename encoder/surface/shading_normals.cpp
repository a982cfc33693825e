#include "encoder/surface/shading_normals.h"

#include <tbb/parallel_sort.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace gim {

namespace {

Vec3 unit_or_zero(const Vec3& v) {
    const double length = v.stableNorm();
    return length > 0 ? Vec3(v / length) : Vec3::Zero();
}

// Returns the area vector. Its length is twice the area.
Vec3 area_vector(const Mesh& mesh, const Triangle& t) {
    return (mesh.positions[t[1]] - mesh.positions[t[0]]).cross(mesh.positions[t[2]] - mesh.positions[t[0]]);
}

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace

std::vector<uint32_t> first_at_position(const Mesh& mesh) {
    std::vector<uint32_t> order(mesh.positions.size()), first(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto place = [&](uint32_t v) {
        const Vec3& p = mesh.positions[v];
        return std::array{p[0], p[1], p[2]};
    };
    tbb::parallel_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        const auto at_a = place(a), at_b = place(b);
        return at_a != at_b ? at_a < at_b : a < b;
    });
    for (size_t i = 0; i < order.size(); ++i) {
        const bool repeats = i > 0 && place(order[i]) == place(order[i - 1]);
        first[order[i]] = repeats ? first[order[i - 1]] : order[i];
    }
    return first;
}

std::vector<Vec3> shading_normals(const Mesh& mesh, NormalWeight weight) {
    const std::vector<uint32_t> first = first_at_position(mesh);
    std::vector<Vec3> normals(mesh.positions.size(), Vec3::Zero());
    for (const Triangle& t : mesh.triangles) {
        const Vec3 area = area_vector(mesh, t), unit = unit_or_zero(area);
        for (size_t i = 0; i < 3; ++i) {
            const Vec3& p = mesh.positions[t[i]];
            if (weight == NormalWeight::kArea) {
                normals[first[t[i]]] += area;
            } else {
                const double angle =
                    angle_between(mesh.positions[t[(i + 1) % 3]] - p, mesh.positions[t[(i + 2) % 3]] - p);
                normals[first[t[i]]] += angle * unit;
            }
        }
    }
    for (size_t v = 0; v < normals.size(); ++v) {
        if (first[v] == v) normals[v] = unit_or_zero(normals[v]);
    }
    for (size_t v = 0; v < normals.size(); ++v) normals[v] = normals[first[v]];
    return normals;
}

Vec3 shading_normal_at(const Mesh& mesh, const std::vector<Vec3>& normals, uint32_t triangle,
                       const std::array<double, 3>& barycentric) {
    const Triangle& t = mesh.triangles[triangle];
    const Vec3 sum = barycentric[0] * normals[t[0]] + barycentric[1] * normals[t[1]] + barycentric[2] * normals[t[2]];
    const Vec3 normal = unit_or_zero(sum);
    return normal.isZero() ? unit_or_zero(area_vector(mesh, t)) : normal;
}

double degrees_between(const Vec3& a, const Vec3& b) {
    return a.isZero() || b.isZero() ? 90 : 180 / std::numbers::pi * angle_between(a, b);
}

}  // namespace gim

#include "tools/polygons.h"

#include <cmath>

namespace gim {
namespace {

using Point2 = std::array<double, 2>;

// Ear clipping costs up to O(n^3); beyond this many corners a fan must do.
constexpr size_t kMaxClippedCorners = 256;

double cross(const Point2& a, const Point2& b, const Point2& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// The face seen along its mean normal (Newell), so that its outline runs counter-clockwise.
std::vector<Point2> flatten(const std::vector<std::array<double, 3>>& positions, std::span<const uint32_t> face) {
    std::array<double, 3> normal = {};
    for (size_t i = 0; i < face.size(); ++i) {
        const std::array<double, 3>& a = positions[face[i]];
        const std::array<double, 3>& b = positions[face[(i + 1) % face.size()]];
        for (size_t k = 0; k < 3; ++k) {
            normal[k] += (a[(k + 1) % 3] - b[(k + 1) % 3]) * (a[(k + 2) % 3] + b[(k + 2) % 3]);
        }
    }
    size_t axis = 0;  // the largest component: dropping it distorts least
    for (size_t k = 1; k < 3; ++k) {
        if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
    }
    const size_t u = normal[axis] >= 0 ? (axis + 1) % 3 : (axis + 2) % 3;
    const size_t v = normal[axis] >= 0 ? (axis + 2) % 3 : (axis + 1) % 3;
    std::vector<Point2> flat(face.size());
    for (size_t i = 0; i < face.size(); ++i) flat[i] = {positions[face[i]][u], positions[face[i]][v]};
    return flat;
}

bool is_convex(const std::vector<Point2>& flat) {
    const size_t n = flat.size();
    for (size_t i = 0; i < n; ++i) {
        if (!(cross(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) > 0)) return false;
    }
    return true;
}

// Whether cutting corner i off leaves the outline whole: the corner is convex and no other corner lies in its triangle.
bool is_ear(const std::vector<Point2>& flat, const std::vector<size_t>& left, size_t i) {
    const size_t n = left.size();
    const size_t ia = left[(i + n - 1) % n];
    const size_t ib = left[i];
    const size_t ic = left[(i + 1) % n];
    if (!(cross(flat[ia], flat[ib], flat[ic]) > 0)) return false;
    for (const size_t j : left) {
        if (j == ia || j == ib || j == ic) continue;
        const Point2& p = flat[j];
        if (cross(flat[ia], flat[ib], p) >= 0 && cross(flat[ib], flat[ic], p) >= 0 &&
            cross(flat[ic], flat[ia], p) >= 0) {
            return false;
        }
    }
    return true;
}

void clip_ears(const std::vector<Point2>& flat, std::span<const uint32_t> face,
               std::vector<std::array<uint32_t, 3>>& triangles) {
    std::vector<size_t> left(face.size());
    for (size_t i = 0; i < left.size(); ++i) left[i] = i;
    while (left.size() > 3) {
        size_t ear = 0;
        while (ear < left.size() && !is_ear(flat, left, ear)) ++ear;
        if (ear == left.size()) ear = 1;  // self-crossing or flat: any triangle is as good
        const size_t n = left.size();
        triangles.push_back({face[left[(ear + n - 1) % n]], face[left[ear]], face[left[(ear + 1) % n]]});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.push_back({face[left[0]], face[left[1]], face[left[2]]});
}

void add_triangles(const std::vector<std::array<double, 3>>& positions, std::span<const uint32_t> face,
                   std::vector<std::array<uint32_t, 3>>& triangles) {
    if (face.size() > 3 && face.size() <= kMaxClippedCorners) {
        const std::vector<Point2> flat = flatten(positions, face);
        if (!is_convex(flat)) return clip_ears(flat, face, triangles);
    }
    for (size_t i = 2; i < face.size(); ++i) triangles.push_back({face[0], face[i - 1], face[i]});
}

}  // namespace

Result<TriangleMesh> triangulate(PolygonSoup soup) {
    const auto vertex_count = static_cast<int64_t>(soup.positions.size());
    if (soup.positions.empty()) return Error{Stage::kInput, "it has no vertices"};
    if (soup.sizes.empty()) return Error{Stage::kInput, "it has vertices but no faces (a point cloud?)"};
    if (vertex_count > int64_t{UINT32_MAX} - 1) return Error{Stage::kInput, "it has more than 2^32 - 2 vertices"};

    TriangleMesh mesh;
    mesh.triangles.reserve(soup.sizes.size());
    std::vector<uint32_t> face;
    size_t first = 0;
    for (size_t f = 0; f < soup.sizes.size(); ++f) {
        const uint32_t size = soup.sizes[f];
        if (size < 3) {
            return Error{Stage::kInput, "face " + std::to_string(f) + " (counted from 0) has " + std::to_string(size) +
                                            " corners instead of three or more"};
        }
        face.clear();
        for (uint32_t i = 0; i < size; ++i) {
            const int64_t corner = soup.corners[first + i];
            if (corner < 0 || corner >= vertex_count) {
                return Error{Stage::kInput, "face " + std::to_string(f) + " uses vertex " + std::to_string(corner) +
                                                " (both counted from 0), but there are only " +
                                                std::to_string(vertex_count) + " vertices"};
            }
            face.push_back(static_cast<uint32_t>(corner));
        }
        first += size;
        add_triangles(soup.positions, face, mesh.triangles);
    }
    mesh.positions = std::move(soup.positions);
    return mesh;
}

}  // namespace gim

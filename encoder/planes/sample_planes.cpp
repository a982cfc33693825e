#include "encoder/planes/sample_planes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "encoder/base/parallel.h"

namespace gim {

namespace {

constexpr size_t kBlock = 4096;
constexpr size_t kMostFacesForCreases = 64;  // a vertex with more counts as smooth, to keep the cost linear

double corner_angle(const Mesh& mesh, uint32_t h) {
    const Vec3& p = mesh.positions[from(mesh, h)];
    const Vec3 a = mesh.positions[to(mesh, h)] - p, b = mesh.positions[from(mesh, prev(h))] - p;
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

std::vector<Vec3> face_normals(const Mesh& mesh) {
    std::vector<Vec3> normals(mesh.triangles.size());
    for (size_t f = 0; f < normals.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        const Vec3& a = mesh.positions[t[0]];
        normals[f] = unit_or_zero((mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a));
    }
    return normals;
}

// Half-edges sorted by their first vertex. Those of vertex v are at first[v] .. first[v+1]-1.
struct Corners {
    std::vector<uint32_t> first, half_edges;
};
Corners corners_of(const Mesh& mesh) {
    Corners c;
    c.first.assign(mesh.positions.size() + 1, 0);
    c.half_edges.resize(mesh.triangles.size() * 3);
    for (const Triangle& t : mesh.triangles) {
        for (const uint32_t v : t) ++c.first[v + 1];
    }
    for (size_t v = 0; v + 1 < c.first.size(); ++v) c.first[v + 1] += c.first[v];
    std::vector<uint32_t> at(c.first.begin(), c.first.end() - 1);
    for (uint32_t h = 0; h < c.half_edges.size(); ++h) c.half_edges[at[from(mesh, h)]++] = h;
    return c;
}

// Returns the normal of each corner: the angle-weighted mean over faces around its vertex, without faces at the crease
// angle or more from the corner's own face.
std::vector<Vec3> corner_normals(const Mesh& mesh, uint32_t threads) {
    const std::vector<Vec3> faces = face_normals(mesh);
    const Corners corners = corners_of(mesh);
    const double least = std::cos(AttributeSource::kCreaseAngle * std::numbers::pi / 180);
    std::vector<Vec3> normals(mesh.triangles.size() * 3);
    parallel_blocks(mesh.positions.size(), kBlock, threads, [&](size_t, size_t begin, size_t end) {
        std::vector<double> angles;
        for (size_t v = begin; v < end; ++v) {
            const std::span<const uint32_t> around =
                std::span(corners.half_edges).subspan(corners.first[v], corners.first[v + 1] - corners.first[v]);
            Vec3 all = Vec3::Zero();
            angles.clear();
            for (const uint32_t h : around) {
                angles.push_back(corner_angle(mesh, h));
                all += angles.back() * faces[face_of(h)];
            }
            for (const uint32_t h : around) {
                const Vec3& own = faces[face_of(h)];
                Vec3 sum = all;
                if (around.size() <= kMostFacesForCreases && own.squaredNorm() > 0) {
                    sum.setZero();
                    for (size_t i = 0; i < around.size(); ++i) {
                        const Vec3& other = faces[face_of(around[i])];
                        if (own.dot(other) >= least) sum += angles[i] * other;
                    }
                }
                const Vec3 mean = unit_or_zero(sum);
                normals[h] = mean.squaredNorm() > 0 ? mean : own;
            }
        }
    });
    return normals;
}

}  // namespace

AttributeSource::AttributeSource(const Mesh& mesh, uint32_t threads)
    : mesh_(mesh), tree_(mesh, threads), corner_normals_(corner_normals(mesh, threads)), threads_(threads) {}

Vec3 AttributeSource::face_normal(uint32_t face) const {
    const Triangle& t = mesh_.triangles[face];
    const Vec3& a = mesh_.positions[t[0]];
    return (mesh_.positions[t[1]] - a).cross(mesh_.positions[t[2]] - a);
}

// Searches again from further and further outside while the face found looks the other way.
void AttributeSource::keep_to_the_right_side(const Vec3& query, const Vec3& outside, double spacing,
                                             ClosestPoint* found) const {
    if (face_normal(found->triangle).dot(outside) >= 0) return;
    const double first = std::max(std::sqrt(found->squared_distance), 0.125 * spacing);
    for (double offset = first; offset <= 8 * first; offset *= 2) {
        const ClosestPoint again = tree_.find(query + offset * outside, found->triangle);
        if (face_normal(again.triangle).dot(outside) <= 0) continue;
        // No near face looks the right way: this is a fold of the image, or the rim of an open surface.
        if ((again.point - query).norm() > 4 * first) return;
        *found = again;
        return;
    }
}

std::vector<ClosestPoint> AttributeSource::locate(std::span<const Texel> texels) const {
    std::vector<Vec3> positions(texels.size());
    for (size_t i = 0; i < texels.size(); ++i) positions[i] = texels[i].position;
    std::vector<ClosestPoint> found = tree_.find_all(positions, threads_);
    parallel_blocks(texels.size(), kBlock, threads_, [&](size_t, size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            keep_to_the_right_side(texels[i].position, texels[i].outside, texels[i].spacing, &found[i]);
    });
    return found;
}

Vec3 AttributeSource::normal(const ClosestPoint& point) const {
    Vec3 n = Vec3::Zero();
    for (size_t i = 0; i < 3; ++i) n += point.barycentric[i] * corner_normals_[3 * size_t{point.triangle} + i];
    return unit_or_zero(n);
}

std::vector<float> AttributeSource::normals(std::span<const ClosestPoint> points) const {
    std::vector<float> values(points.size() * 3);
    parallel_blocks(points.size(), kBlock, threads_, [&](size_t, size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Vec3 n = normal(points[i]);
            for (int k = 0; k < 3; ++k) values[3 * i + static_cast<size_t>(k)] = static_cast<float>(n[k]);
        }
    });
    return values;
}

}  // namespace gim

// Closest points on a triangle mesh, by a bounding-volume hierarchy. Exact (double precision), deterministic.
//
// Four-wide tree of float boxes, split by the surface-area heuristic, with exact double tests in leaves of up to four
// triangles. The boxes are rounded outwards, so they decide only what is looked at, never the result. Any mesh will do:
// zero-area triangles count as the segments or points that they are.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

struct ClosestPoint {
    Vec3 point = Vec3::Zero();                      // on the surface
    std::array<double, 3> barycentric = {0, 0, 0};  // of `point` in its triangle; zero entries tell an edge or a vertex
    uint32_t triangle = kNone;                      // smallest index among equally near triangles; kNone: no triangles
    double squared_distance = 0;
};

class ClosestPointTree {
  public:
    // Keeps its own copy of the corner positions, which must be finite. O(F log F).
    explicit ClosestPointTree(const Mesh& mesh, uint32_t threads = 0);
    ~ClosestPointTree();
    ClosestPointTree(ClosestPointTree&&) noexcept;
    ClosestPointTree& operator=(ClosestPointTree&&) noexcept;

    // `hint`: a triangle that is probably near (kNone: none); changes speed, never the result. About a microsecond for
    // a query near the surface. Safe to call from many threads.
    ClosestPoint find(const Vec3& query, uint32_t hint = kNone) const;

    // Every query of a span, in parallel. `hints` is empty or has one entry per query. Fastest when neighbours in the
    // span are neighbours in space: each query also tries its predecessor's triangle.
    std::vector<ClosestPoint> find_all(std::span<const Vec3> queries, uint32_t threads = 0,
                                       std::span<const uint32_t> hints = {}) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Closest point of one triangle; `triangle` in the result is left at kNone.
ClosestPoint closest_point_on_triangle(const Vec3& query, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace gim

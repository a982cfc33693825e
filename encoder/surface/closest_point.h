// Finds closest points on a triangle mesh with a bounding-volume hierarchy. Exact (double precision), deterministic.
//
// The hierarchy is a four-wide tree of float boxes, split by the surface-area heuristic. Leaves hold one or two
// triangles, which are tested exactly in double precision. Boxes are rounded outwards, so they decide only which
// triangles are tested, never the result. Any mesh will do: zero-area triangles count as segments or points.
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
    std::array<double, 3> barycentric = {0, 0, 0};  // of `point` in its triangle; zeros mark an edge or a vertex
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

    // Becomes the tree of this mesh. Keeps its shape if the number of triangles is the same: the results are those of a
    // new tree, and queries are about as fast while triangles stay near their old places. O(F), a tenth of building.
    void refit(const Mesh& mesh, uint32_t threads = 0);

    // `hint` is a triangle that is probably near (kNone: none). It changes the speed, never the result. A query near
    // the surface takes about a microsecond. Many threads may call this at once.
    ClosestPoint find(const Vec3& query, uint32_t hint = kNone) const;

    // Answers all queries, in parallel. `hints` is empty or has one entry per query. This is fastest if neighbours in
    // the span are neighbours in space, because each query also tries its predecessor's triangle.
    std::vector<ClosestPoint> find_all(std::span<const Vec3> queries, uint32_t threads = 0,
                                       std::span<const uint32_t> hints = {}) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Returns the closest point of one triangle. Leaves `triangle` in the result at kNone.
ClosestPoint closest_point_on_triangle(const Vec3& query, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace gim

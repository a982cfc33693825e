// Closest points on a triangle mesh, by a bounding-volume hierarchy. Exact (double precision), deterministic.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "encoder/mesh.h"

namespace gim {

struct ClosestPoint {
    Vec3 point;                 // on the surface
    std::array<double, 3> barycentric;  // of `point` in its triangle; zero entries tell an edge or a vertex
    uint32_t triangle = kNone;  // smallest index among equally near triangles
    double squared_distance = 0;
};

class ClosestPointTree {
  public:
    // Keeps its own copy of the corner positions. O(F log F).
    explicit ClosestPointTree(const Mesh& mesh);
    ~ClosestPointTree();
    ClosestPointTree(ClosestPointTree&&) noexcept;
    ClosestPointTree& operator=(ClosestPointTree&&) noexcept;

    // `hint`: a triangle that is probably near (kNone: none); changes speed, never the result.
    ClosestPoint find(const Vec3& query, uint32_t hint = kNone) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gim

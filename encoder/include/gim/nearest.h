// Finds what of a mesh is nearest to points of another surface, to carry attributes from the mesh to its decoded surface.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gim/encoder.h"

namespace gim {

struct SurfaceQuery {
    std::array<double, 3> position;
    std::array<double, 3> outside;  // unit normal of the other surface there; 0 0 0: not known
    double spacing = 0;             // about how far queries are apart
};

struct SurfacePoint {
    uint32_t triangle = UINT32_MAX;      // of the mesh; UINT32_MAX: it has none with an area
    std::array<double, 3> weights = {};  // of its corners; they add up to 1
};

class NearestPoints {
  public:
    // The mesh must have finite positions. Triangles without area are left out. O(F log F).
    explicit NearestPoints(const TriangleMesh& mesh, uint32_t threads = 0);
    ~NearestPoints();
    NearestPoints(NearestPoints&&) noexcept;

    // Returns the nearest point of each query. If its triangle looks the other way, one nearby that does not is taken: on a
    // thin sheet both sides are near. In parallel; O(queries log F).
    std::vector<SurfacePoint> find(std::span<const SurfaceQuery> queries) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gim

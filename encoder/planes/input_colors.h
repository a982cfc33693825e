// The colour of any point of the input's surface, from the textures and corner colours of the closest triangle.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "encoder/surface/closest_point.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// An Error unless the arrays fit the mesh and each other.
Result<void> check_appearance(const TriangleMesh& mesh);

class InputColors {
  public:
    // Keeps a reference to the mesh. Its appearance must be valid and not empty. Degenerate triangles are left out:
    // they have no surface, and cleaning may have moved what lies next to them. O(F log F).
    explicit InputColors(const TriangleMesh& mesh, uint32_t threads = 0);

    // Returns the sRGB colours of surface points, 0..255: one triple per point. Textures are bilinear. O(points log F).
    std::vector<float> at(std::span<const Vec3> points) const;

  private:
    std::array<float, 3> color(const ClosestPoint& at) const;

    const TriangleMesh& mesh_;
    std::vector<uint32_t> source_;  // per triangle of the tree: the triangle of the mesh
    ClosestPointTree tree_;
    uint32_t threads_;
};

}  // namespace gim

// Normals as a renderer that only has the mesh would shade it: one per vertex, interpolated over the triangles.
//
// A vertex's normal is the sum of the area vectors of the triangles around it (area-weighted: slivers, which quantization
// turns any way, count for nothing). Vertices at exactly equal positions count as one, so the seams of files that repeat
// vertices do not show. In: any mesh. Cost: O(V log V + F). Deterministic.
#pragma once

#include <array>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// Unit length, one per vertex; zero where the triangles cancel or there are none.
std::vector<Vec3> shading_normals(const Mesh& mesh);

// The normal inside a triangle. Where the interpolated one vanishes the triangle's own; zero where that does too.
Vec3 shading_normal_at(const Mesh& mesh, const std::vector<Vec3>& normals, uint32_t triangle,
                       const std::array<double, 3>& barycentric);

}  // namespace gim

// Computes the normals with which a renderer that has only the mesh would shade it: one per vertex, interpolated over
// the triangles.
//
// A vertex's normal is the weighted sum of the normals of the triangles around it. Weighting by area makes slivers,
// which quantization turns any way, count for nothing. Weighting by the angle at the vertex is what most renderers do;
// slivers show. Vertices at exactly equal positions count as one, so the seams of files that repeat vertices do not
// show. In: any mesh. Cost: O(V log V + F). Deterministic.
#pragma once

#include <array>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

enum class NormalWeight { kArea, kAngle };

// Returns one normal per vertex, of unit length. It is zero if the triangles cancel or there are none.
std::vector<Vec3> shading_normals(const Mesh& mesh, NormalWeight weight);

// Returns for each vertex the first one at its position.
std::vector<uint32_t> first_at_position(const Mesh& mesh);

// Returns the normal at a point of a triangle. If the interpolated normal vanishes, returns the triangle's own. It is
// zero if that vanishes too.
Vec3 shading_normal_at(const Mesh& mesh, const std::vector<Vec3>& normals, uint32_t triangle,
                       const std::array<double, 3>& barycentric);

// Returns the angle between two normals, in degrees; 90 if one of them is zero.
double degrees_between(const Vec3& a, const Vec3& b);

}  // namespace gim

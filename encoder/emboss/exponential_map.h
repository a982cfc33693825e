// Lays a plane on a surface around a point: a discrete exponential map.
// Schmidt, Grimm, Wyvill. Interactive Decal Compositing with Discrete Exponential Maps. SIGGRAPH 2006. Section 3, with the
// average over all upwind neighbours of Schmidt, Stroke Parameterization (Eurographics 2013), section 3, which is smoother.
#pragma once

#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// The middle of the map and its axes: right, up and outside are orthonormal.
struct MapOrigin {
    uint32_t triangle = 0;
    Vec3 point = Vec3::Zero();  // in that triangle
    Vec3 right = Vec3::UnitX(), up = Vec3::UnitY(), outside = Vec3::UnitZ();
};

// Returns a point of the plane for each vertex up to `radius` away along edges, NaN for the others. normals: unit, per
// vertex. Vertices must not be shared by surfaces that only touch. O(n log n) in the vertices reached.
std::vector<Vec2> exponential_map(const Mesh& mesh, const std::vector<Vec3>& normals, const MapOrigin& origin,
                                  double radius);

}  // namespace gim

// Judges the quad that two triangles make.
#pragma once

#include "encoder/surface/mesh.h"

namespace gim {

// The quad a, b, c, d, counter-clockwise, is cut along a-c. Returns about 1 for a flat square, less the more its corners
// (unfolded into the plane) differ from right angles, its sides in length, and the normals of its halves.
double quad_shape(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace gim

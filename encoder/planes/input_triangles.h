// The triangles of an input that have a surface, to find the input's point that is nearest to another.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Returns the mesh without triangles of no area. source: gets the triangle of the input that each one is.
Mesh triangles_with_area(const TriangleMesh& mesh, std::vector<uint32_t>* source);

}  // namespace gim

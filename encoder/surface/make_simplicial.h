// Splits edges and faces so that no two of them have the same vertices.
//
// Where a surface touches itself, joined faces can give two edges between the same two vertices, or two faces on the
// same three. Tables of edges by vertices cannot tell these apart. A vertex in the middle can.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// twin: per half-edge of an oriented mesh; kNone on boundaries. origin: per vertex; new vertices get that of an end.
// Returns the number of new vertices. The surface stays where it is. Cost: O(F log F).
uint64_t make_simplicial(Mesh& mesh, std::vector<uint32_t>& twin, std::vector<uint32_t>& origin);

}  // namespace gim

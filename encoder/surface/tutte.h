// Tutte's barycentric map with uniform weights: every free vertex is the mean of its neighbours. The map is injective
// if the mesh is a disk, its border is fixed to a convex polygon, and no chord runs along a side.
// Tutte. How to Draw a Graph. Proceedings of the London Mathematical Society, 1963.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// In:  arcs (vertex, neighbour), one for each neighbour of every free vertex, in any order; arcs of fixed vertices are
//      ignored. uv of the fixed vertices.
// Out: uv of the free vertices. Returns false if the system cannot be solved.
// Cost: one sparse factorization.
bool solve_tutte(const std::vector<std::array<uint32_t, 2>>& arcs, const std::vector<uint8_t>& fixed,
                 std::vector<Vec2>& uv);

}  // namespace gim

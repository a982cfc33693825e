// Tutte's barycentric map with uniform weights: every free vertex at the mean of its neighbours. Injective for a disk
// whose border is fixed to a convex polygon without chords along a side.
// Tutte. How to Draw a Graph. Proceedings of the London Mathematical Society, 1963.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// In:  arcs (vertex, neighbour): of every free vertex one for each of its neighbours, in any order; others are left out.
//      uv of the fixed vertices. Out: uv of the free ones. False when the system cannot be solved.
// Cost: one sparse factorization.
bool solve_tutte(const std::vector<std::array<uint32_t, 2>>& arcs, const std::vector<uint8_t>& fixed,
                 std::vector<Vec2>& uv);

}  // namespace gim

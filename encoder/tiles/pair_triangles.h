// Pairs the triangles of a base mesh into quads.
//
// After: Maximo, Velho, Siqueira 2013 (4.2): a maximum-weight perfect matching of the dual graph. We differ: the weights
// are adapted until as few vertices as possible have other than four quads, so that hardly any vertex has only two.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/tiles/base_mesh.h"

namespace gim {

struct QuadPairing {
    // Base vertices, counter-clockwise. The triangles of a quad meet along corners 0 and 2.
    std::vector<std::array<uint32_t, 4>> quads;
    std::vector<std::array<uint32_t, 2>> triangles;  // per quad: its base triangles, corners 0 1 2 and 0 2 3
    std::vector<std::array<uint32_t, 2>> crossed;    // creases that had to become diagonals
    std::vector<uint32_t> doublets;                  // vertices, not on a boundary, where only two quads meet
    uint32_t twins = 0;                              // pairs of quads with the same four vertices
    std::vector<uint32_t> unpaired;                  // triangles of components that have no perfect matching
};

// In:   positions of the input's vertices, a base of it, and how often the weights are adapted.
// Cost: O(F^2 log F) a component and round, about a millisecond for 400 triangles.
QuadPairing pair_triangles(const std::vector<Vec3>& positions, const BaseMesh& base, uint32_t rounds = 40);

}  // namespace gim

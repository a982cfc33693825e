// Maps an opened mesh into the unit disk with mean-value coordinates. The stretch of this map shows where the surface
// protrudes.
//
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3.2, "Iterated cut augmentation". We take Floater's
// mean-value coordinates (Floater. Mean Value Coordinates. CAGD 2003) instead of his shape-preserving ones: their
// weights are positive too, and they are smooth in the vertex positions.
#pragma once

#include <vector>

#include "encoder/squares/open_mesh.h"

namespace gim {

// Returns the uv of each vertex. The boundary loop lies on the unit circle, spaced by edge length. Empty if the linear
// system cannot be solved. Cost: one sparse LU factorization of the interior.
std::vector<Vec2> circle_map(const OpenedMesh& opened);

}  // namespace gim

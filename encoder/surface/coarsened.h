// Coarsens a surface that is much denser than the image that it becomes.
//
// Cut, charts and map then cost what the image deserves, not what the input brings. The fit to the codec takes the samples to the
// input itself.
#pragma once

#include "encoder/surface/mesh.h"

namespace gim {

// mesh: an oriented 2-manifold. Returns it with about that many vertices by half-edge collapses (progressive_mesh.h), or as it is if
// it has no more. Keeps its topology and its boundary vertices. Cost: O(V log V).
Mesh coarsened_to(const Mesh& mesh, double vertices);

}  // namespace gim

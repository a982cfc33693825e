// Drops sharp edges that form no lines worth keeping.
#pragma once

#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// Connected sharp edges with loose ends stay if they are long and have several edges for each end; those without, if they
// are not tiny. sharp: per half-edge 3f+i, both of an edge; boundaries are not sharp. Cost: O(F).
void drop_short_lines(const Mesh& mesh, const Topology& topology, std::vector<bool>& sharp);

}  // namespace gim

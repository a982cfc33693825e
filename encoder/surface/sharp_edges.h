// Finds the edges of a surface at which it is meant to be sharp: the creases of machined parts.
//
// After: Hubeli, Gross. Multiresolution Feature Extraction for Unstructured Meshes. Visualization 2001 (classification of
// edges, hysteresis). We differ: an edge is compared with those beside it. A crease bends the surface much more than the
// next edges on both sides do. So a coarse cylinder, a fillet and a scan have no creases, whatever their angles.
//
// Edges are sharp at once if their angle is large, and continue such edges if it is smaller. What does not connect to
// long lines is left out.
#pragma once

#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// In:  an oriented 2-manifold.
// Out: per half-edge 3f+i whether its edge is sharp; both half-edges of an edge are marked. Boundaries are not.
// Cost: O(F log F).
std::vector<bool> sharp_edges(const Mesh& mesh);

}  // namespace gim

// Splits large faces, so that they do not constrain the cut and the parametrization.
//
// After: Rivara. New longest-edge algorithms for the refinement and/or improvement of unstructured triangulations.
// IJNME 1997. A face is split at the middle of its longest edge. Neighbours for which that edge is not the longest are
// split first.
#pragma once

#include "encoder/surface/mesh.h"

namespace gim {

// In:  an oriented 2-manifold.
// Out: the same surface, with no face larger than `largest` (area). Input vertices and faces keep their numbers; one
//      part of a split face keeps the number of that face.
// Cost: O(F + splits), with about 2 * area / largest splits.
Mesh refine_large_faces(Mesh mesh, double largest);

// Does the same until no edge is longer than `longest`. That also splits needles, which have little area. The number of
// splits is about the sum over faces of (longest edge / `longest`).
Mesh refine_long_edges(Mesh mesh, double longest);

// Returns the total area of the surface.
double surface_area(const Mesh& mesh);

}  // namespace gim

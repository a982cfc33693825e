// Splits large faces, so that they do not tie the cut and the parametrization down.
//
// After: Rivara. New longest-edge algorithms for the refinement and/or improvement of unstructured triangulations.
// IJNME 1997: a face is split at the middle of its longest edge, after the neighbours for which that edge is not the
// longest.
#pragma once

#include "encoder/surface/mesh.h"

namespace gim {

// In:  an oriented 2-manifold. Out: the same surface, no face larger than `largest` (area). Input vertices and faces
// keep their numbers (a split face keeps its number for one of its parts). Cost: O(F + splits), splits about 2 * area /
// largest.
Mesh refine_large_faces(Mesh mesh, double largest);

// The same until no edge is longer than `longest`: needles too, which an area does not tell. Splits about sum over faces
// of (longest edge / `longest`).
Mesh refine_long_edges(Mesh mesh, double longest);

// Total area of the surface.
double surface_area(const Mesh& mesh);

}  // namespace gim

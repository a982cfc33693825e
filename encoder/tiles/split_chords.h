// Splits the edges that would be flat in the tiles: those that join two vertices of creases or boundaries across faces.
//
// Creases and boundaries lie on the borders of tiles, which are straight. A face with all corners on one border has no
// area there. A face that fills a corner between two creases spans all tiles between them.
#pragma once

#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// In:  a mesh; per half-edge 3f+i whether it lies on a crease (empty: none do; one half-edge of two is enough).
// Out: the same surface, in which every edge between two such vertices is itself a crease or a boundary. Vertices keep
//      their numbers; one part of a split face keeps its number. `sharp` is that of the new faces.
// Cost: O(F log F).
void split_chords(Mesh& mesh, std::vector<bool>& sharp);

}  // namespace gim

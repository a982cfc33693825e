// Lays the triangles of a base mesh out in its tiles. That is where the hierarchy of the map starts.
#pragma once

#include <vector>

#include "encoder/base/result.h"
#include "encoder/tiles/flat_mesh.h"

namespace gim {

// In:  the base triangles, and the tiles made of them: corners are base vertices, sides are base edges. Vertices that no
//      tile has as a corner lie inside of one.
// Out: a face for each triangle. Fails if a triangle belongs to no tile. Cost: O(F) if few vertices lie inside tiles.
Result<std::vector<FlatFace>> start_map(const std::vector<Triangle>& triangles, const std::vector<Quad>& quads,
                                        uint32_t vertex_count);

}  // namespace gim

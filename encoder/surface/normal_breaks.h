// Finds where the normals of the input break: the angle between those of the two faces at each edge.
//
// Places count, not vertices: files that split vertices on hard edges and files that share them give the same. Cleaning
// may split, weld and turn what it likes as long as both ends of an edge stay.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// In:  the input, with the place of each of its vertices (see weld_places.h); the mesh that became of it, with an input
//      vertex for each of its own.
// Out: per half-edge 3f+i the angle between the normals of the input's faces at its edge, in degrees; the smaller one of
//      both ends. Where one crease ends in a smooth surface, the other end tells. 0 where faces do not meet in pairs.
//      Empty if the input has no normals. Where more than two faces meet, those that agree best tell.
// Cost: O(F log F).
std::vector<float> find_breaks(const TriangleMesh& input, std::span<const uint32_t> place, const Mesh& mesh,
                               std::span<const uint32_t> source_vertex);

}  // namespace gim

// Takes triangles without area out of a surface and keeps the surface closed.
//
// A triangle of three collinear points closes a T-junction: its middle point lies on the edge of a neighbour. That edge
// is flipped, so that the neighbour is split at the point. At a boundary the triangle is dropped. Botsch, Kobbelt. A
// Robust Procedure to Eliminate Degenerate Faces from Triangle Meshes. 2001 (the "cap"; needles are welded before).
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

struct SliverCounts {
    uint64_t flipped = 0, dropped = 0;
    uint64_t left = 0;               // slivers that could not be taken out
    std::vector<uint32_t> vertices;  // the middle points of the first few
};

// mesh: an oriented manifold. thickness: a triangle is a sliver if its smallest height is not above it. Keeps vertices
// and their numbers, and faces in order. May leave vertices without faces, and vertices of several fans at boundaries.
// Cost: O(F) and O(1) for each sliver.
SliverCounts flip_slivers(Mesh& mesh, double thickness);

}  // namespace gim

// The quads of the tiles: a base mesh of about a wanted size that can be paired without faults.
//
// A cut through the hierarchy may leave a patch between creases, or a component with boundaries, with an odd number of
// faces, or vertices where only two quads would meet. A few more collapses repair that. Where they do not, a slightly
// finer cut is tried. Each component is treated by itself.
#pragma once

#include "encoder/tiles/base_mesh.h"
#include "encoder/tiles/pair_triangles.h"

namespace gim {

struct TileBase {
    BaseMesh base;
    QuadPairing pairing;  // its triangles are those of the base
};

// A mesh whose components have enough faces for tiles.
struct TileInput {
    Mesh mesh;
    std::vector<bool> sharp;
};

// Splits faces of small components, and an edge where all boundaries of a component have three edges, an odd number in
// all. The surface stays the same. Vertices keep their numbers. O(F).
TileInput make_room_for_tiles(Mesh mesh, std::vector<bool> sharp);

// In:  what the hierarchy was made from (see make_room_for_tiles), and about how many triangles the base should have.
// Out: a base that has a few triangles less or more, and its quads. Faults that no cut was without are in the pairing.
// Cost: O(F), and a few milliseconds for each try.
TileBase make_tile_base(const TileInput& input, const BaseHierarchy& hierarchy, uint32_t triangles);

}  // namespace gim

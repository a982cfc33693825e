// Chooses the base of one component, and pairs its triangles.
#pragma once

#include "encoder/tiles/decimator.h"
#include "encoder/tiles/pair_triangles.h"

namespace gim {

// A component at a fine cut through its hierarchy, with vertices and faces numbered from 0.
struct PartMesh {
    Mesh mesh;
    std::vector<bool> sharp;
    std::vector<VertexShare> shares;
    std::vector<HalfEdgeCollapse> collapses;  // that follow
};

struct PartBase {
    std::vector<HalfEdgeCollapse> collapses;  // of the part
    std::vector<uint32_t> removed_by;         // per face of the part; see Decimator
};

// Makes the first `count` collapses of the part and a few of its own, or fewer, until pairing leaves no fault. If no try
// is without fault, returns the one with the fewest.
PartBase choose_part_base(const PartMesh& part, uint32_t count);

}  // namespace gim

// The topological sideband: how the boundary of the square is glued together.
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3.3. We store mates by index instead of label strings,
// and lengths in units of the node grid (the coarsest grid on which every cut-node is a grid point).
//
// The ring: the 4*(side-1) boundary samples of a side x side image, starting at row 0, column 0 and walking row 0 with
// rising column, then the last column with rising row, then the last row with falling column, then column 0 with
// falling row.
#pragma once

#include <cstdint>
#include <vector>

#include "format/mate.h"

namespace gim {

// One run of ring samples between two cut-nodes, in ring order. Mates run in opposite directions (orientable surfaces).
struct CutPath {
    uint32_t mate = kNoMate;  // index of the mate in Sideband::paths, or kNoMate
    uint32_t length = 0;      // units of the node grid, >= 1; equal for mates

    friend bool operator==(const CutPath&, const CutPath&) = default;
};

struct Sideband {
    uint32_t node_side = 0;      // side of the node grid, 2^j + 1, at most the image's side
    uint32_t start = 0;          // ring index (node grid) of the first cut-node, 0 .. 4*(node_side-1)-1
    std::vector<CutPath> paths;  // in ring order; lengths sum to 4*(node_side-1)

    friend bool operator==(const Sideband&, const Sideband&) = default;
};

}  // namespace gim

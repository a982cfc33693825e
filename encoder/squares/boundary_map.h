// Maps the boundary of the opened mesh onto the boundary of the square.
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3.1, "Boundary parametrization", and section 4
// (mip-mapping).
//
// Each cut-path gets a length proportional to its length on the surface, in whole units of the node grid (the coarsest
// intended mip level), so that cut-nodes are grid points of every level; mates get equal lengths. We differ from the
// paper in that the unit is that of the node grid, and that the node grid is refined when whole units would give short
// cut-paths too much of the boundary.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/squares/open_mesh.h"
#include "format/sideband.h"

namespace gim {

struct BoundaryMapOptions {
    uint32_t side = 257;      // samples per side of the image, 2^j + 1
    uint32_t node_side = 17;  // coarsest grid on which cut-nodes should lie, 2^i + 1 <= side; raised when too coarse
    double most_excess =
        0.1;  // part of the ring that cut-paths may have beyond their shares: what makes a grid too coarse
    uint32_t least_units =
        1;  // of each cut-path, at least 1; those of a loop and of parallel paths have more in any case
};

// The opened mesh with its boundary laid out. Edges that span a corner of the square have been split there (with their
// mates), and edges between two vertices on one side have been split at their middle, so that no triangle is flat.
struct SquareBoundary {
    OpenedMesh opened;
    Sideband sideband;
    std::vector<double>
        ring;  // per entry of opened.loop: ring position in samples of the image, rising from sideband.start
    std::vector<uint8_t>
        sides;  // per vertex: bit s set when it lies on side s (row 0, last column, last row, column 0)
};
Result<SquareBoundary> map_boundary(OpenedMesh opened, const BoundaryMapOptions& options);

// uv per vertex of the opened mesh with the boundary in place; interior vertices at the centre, to be solved for.
std::vector<Vec2> boundary_uv(const SquareBoundary& boundary, uint32_t side);

// Point of the unit square (u along columns, v along rows) at ring position p of a side x side image, 0 <= p <
// 4*(side-1).
Vec2 ring_point(double p, uint32_t side);

}  // namespace gim

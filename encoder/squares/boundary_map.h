// Maps the boundary of the opened mesh onto the boundary of the square.
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3.1, "Boundary parametrization", and section 4
// (mip-mapping).
//
// Each cut-path gets a length proportional to its length on the surface, in whole units of the node grid (the coarsest
// intended mip level). Cut-nodes are therefore grid points of every level. Mates get equal lengths. We differ from the
// paper in two ways: the unit is that of the node grid, and the node grid is refined if whole units would give short
// cut-paths too much of the boundary.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/squares/open_mesh.h"
#include "format/sideband.h"

namespace gim {

struct BoundaryMapOptions {
    uint32_t side = 257;      // samples per side of the image, 2^j + 1
    uint32_t node_side = 17;  // coarsest grid on which cut-nodes should lie, 2^i + 1 <= side; raised if too coarse
    // A grid is too coarse if cut-paths get more than this part of the ring beyond their shares.
    double most_excess = 0.1;
    // Least length of a cut-path, at least 1. Loops and parallel paths have a higher minimum of their own.
    uint32_t least_units = 1;
};

// The opened mesh with its boundary laid out. So that no triangle is flat, some edges are split: boundary edges that
// span a corner of the square are split there (with their mates), and interior edges between two vertices on one side
// are split at their middle.
struct SquareBoundary {
    OpenedMesh opened;
    Sideband sideband;
    // Per entry of opened.loop: ring position in samples of the image, rising from sideband.start.
    std::vector<double> ring;
    // Per vertex: bit s is set if it lies on side s (row 0, last column, last row, column 0).
    std::vector<uint8_t> sides;
};
// Returns an Error if the boundary is too short for the cut-paths, whatever their lengths on the surface are.
Result<void> check_room(const OpenedMesh& opened, const BoundaryMapOptions& options);

Result<SquareBoundary> map_boundary(OpenedMesh opened, const BoundaryMapOptions& options);

// Returns the uv of each vertex of the opened mesh. The boundary is in place. Interior vertices are at the centre and
// still have to be solved for.
std::vector<Vec2> boundary_uv(const SquareBoundary& boundary, uint32_t side);

// Returns the point of the unit square (u along columns, v along rows) at ring position p of a side x side image.
// 0 <= p < 4*(side-1).
Vec2 ring_point(double p, uint32_t side);

}  // namespace gim

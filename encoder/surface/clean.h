// Turns triangles as read from a file into the mesh that the stages work on, or says what is wrong with them.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"
#include "encoder/surface/topology_summary.h"
#include "gim/encoder.h"

namespace gim {

struct CleanOptions {
    bool require_connected = true;  // false: allows several components (one image each, or a layout that takes them)
};

struct CleanReport {
    uint64_t welded_vertices = 0;        // vertices merged into another at the same position
    uint64_t degenerate_triangles = 0;   // removed: they repeat a vertex
    uint64_t duplicate_triangles = 0;    // removed: an earlier one has the same three vertices
    uint64_t unreferenced_vertices = 0;  // removed
    uint64_t flipped_triangles = 0;      // turned over, to agree with their neighbours or to face outwards
    TopologySummary topology;            // of the result
};

struct CleanMesh {
    Mesh mesh;                            // oriented 2-manifold without unreferenced vertices
    std::vector<uint32_t> source_vertex;  // per vertex: its (first) index in the input
    CleanReport report;
};

// In:  finite positions, and triangles that index them. Otherwise returns an Error.
// Out: an oriented manifold, connected if the options require it. Closed components face outwards. Zero-area triangles
//      with three distinct vertices stay, because they are part of the connectivity.
// Welds vertices only along pairs of boundary edges at exactly equal positions (triangle soup, seams). Welding
// therefore shuts gaps and cannot pinch the surface: two sheets that merely touch stay apart. Cost: O(F log F).
Result<CleanMesh> clean(const TriangleMesh& input, const CleanOptions& options = {});

}  // namespace gim

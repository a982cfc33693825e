// Turns triangles as read from a file into the mesh that the stages work on, or says what is wrong with them.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"
#include "encoder/surface/topology_summary.h"
#include "gim/encoder.h"

namespace gim {

struct CleanOptions {
    bool require_connected = true;  // false: several components are fine (one image each, or a layout that takes them)
};

struct CleanReport {
    uint64_t welded_vertices = 0;        // vertices that became one with another at the same position
    uint64_t degenerate_triangles = 0;   // removed: a repeated vertex
    uint64_t duplicate_triangles = 0;    // removed: the same three vertices as an earlier one
    uint64_t unreferenced_vertices = 0;  // removed
    uint64_t flipped_triangles = 0;      // turned round, to agree with their neighbours or to face outwards
    TopologySummary topology;            // of the result
};

struct CleanMesh {
    Mesh mesh;                            // oriented 2-manifold without unreferenced vertices
    std::vector<uint32_t> source_vertex;  // per vertex: its (first) index in the input
    CleanReport report;
};

// In:  finite positions and triangles that index them; else an Error.
// Out: an oriented manifold, connected if asked for; closed components face outwards. Zero-area triangles with three
// distinct
//      vertices stay: they are part of the connectivity.
// Vertices are welded only along pairs of boundary edges at exactly equal positions (triangle soup, seams), so welding
// shuts gaps and cannot pinch the surface: two sheets that merely touch stay apart. Cost: O(F log F).
Result<CleanMesh> clean(const TriangleMesh& input, const CleanOptions& options = {});

}  // namespace gim

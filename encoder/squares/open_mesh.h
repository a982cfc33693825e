// Opens a mesh along its cut: every cut edge becomes two boundary edges (mates) of a mesh M' with the topology of a
// disk. Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"
#include "format/mate.h"
#include "gim/encoder.h"

namespace gim {

// The cut rho: per half-edge of M, 1 on both half-edges of a cut edge. Input boundary edges are always part of the cut
// and need no mark.
using CutEdges = std::vector<uint8_t>;

// A directed run of boundary edges of M' between two cut-nodes.
struct BoundaryPath {
    uint32_t first = 0;       // index into OpenedMesh::loop of its first vertex; it ends where the next path begins
    uint32_t mate = kNoMate;  // index of the path on the other side of the cut; it runs the other way
    uint32_t begin_node = 0, end_node = 0;  // cut-nodes: vertices of M
};

struct OpenedMesh {
    Mesh mesh;                        // M'
    std::vector<uint32_t> source;     // per vertex of M': its vertex of M; kNone for vertices inserted later
    std::vector<uint32_t> loop;       // boundary vertices of M', faces on the left; starts at a cut-node
    std::vector<BoundaryPath> paths;  // in loop order
};

// Fails unless M' is a disk: Euler characteristic 1, one boundary loop. O(F).
Result<OpenedMesh> open_mesh(const Mesh& mesh, const Topology& topology, const CutEdges& cut);

// M' of any cut, disk or not. Each sector between cut edges at a vertex becomes one vertex. Faces and corners keep
// their numbers. O(F).
struct SplitMesh {
    Mesh mesh;
    std::vector<uint32_t> source;  // per vertex: its vertex of the input mesh
};
SplitMesh split_along(const Mesh& mesh, const Topology& topology, const CutEdges& cut);

// Returns whether opening along `cut` gives a disk. Straightening relies on this cheap test. O(F).
bool opens_to_disk(const Mesh& mesh, const Topology& topology, const CutEdges& cut);

inline bool is_cut(const Topology& topology, const CutEdges& cut, uint32_t h) {
    return topology.twin[h] == kNone || cut[h];
}
// Returns the boundary half-edge of M' that follows the boundary half-edge h.
uint32_t next_on_cut(const Topology& topology, const CutEdges& cut, uint32_t h);
// Returns the number of cut edges at each vertex of M. Input boundary edges count.
std::vector<uint32_t> cut_valence(const Mesh& mesh, const Topology& topology, const CutEdges& cut);

}  // namespace gim

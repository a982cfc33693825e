// The initial cut that opens a surface into a disk, and its straightening.
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3.2, "Initial cut".
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "encoder/squares/open_mesh.h"
#include "encoder/surface/edge_paths.h"
#include "encoder/surface/mesh.h"

namespace gim {

// Removes triangles in order of distance from a seed triangle, then trims dangling edges. For a closed surface of genus
// 0 nothing would remain: two adjacent edges opposite the seed are returned then. Input boundaries are part of the cut
// without being marked. In: connected. O(F log F).
CutEdges initial_cut(const Mesh& mesh, const Topology& topology, uint32_t seed_triangle);

struct StraightenOptions {
    double widest = std::numeric_limits<double>::infinity();  // object units: how far a path may move from where it was
    std::vector<uint32_t> fixed;                              // vertices that the cut must keep passing through
};

// Replaces each cut-path by a shorter one between the same cut-nodes, as long as the cut still opens the mesh into a
// disk: first within the widest band around the old path, then within ever narrower ones. O(paths * F) in all. We
// differ from the paper in that the band may be as wide as the surface; the disk test makes that safe.
CutEdges straighten_cut(const Mesh& mesh, const Topology& topology, const CutEdges& cut,
                        const StraightenOptions& options = {});

// Exchanges cut-paths for shorter ones whose ends may lie elsewhere: without a path that is not dangling the opened
// surface is an annulus, and the shortest path between its two boundary loops makes it a disk again. Repeats until
// nothing is gained. The cut must open the mesh into a disk; it still does afterwards. O(passes * paths * F log F):
// meant for coarse meshes.
CutEdges shorten_cut(const Mesh& mesh, const Topology& topology, const CutEdges& cut);

// Marks (or clears) a path of half-edges in the cut.
void mark_path(const Topology& topology, const std::vector<uint32_t>& half_edges, uint8_t value, CutEdges& cut);

// Sum of the lengths of the cut's edges, input boundaries left out.
double cut_length(const Mesh& mesh, const Topology& topology, const CutEdges& cut);

}  // namespace gim

// Makes the initial cut, which opens a surface into a disk, and straightens cuts.
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3.2, "Initial cut".
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "encoder/squares/open_mesh.h"
#include "encoder/surface/edge_paths.h"
#include "encoder/surface/mesh.h"

namespace gim {

// Removes triangles in order of distance from a seed triangle, then trims dangling edges. On a closed surface of genus
// 0 nothing would remain, so the cut is two adjacent edges opposite the seed. Input boundaries are part of the cut but
// are not marked. The mesh must be connected. O(F log F).
CutEdges initial_cut(const Mesh& mesh, const Topology& topology, uint32_t seed_triangle);

struct StraightenOptions {
    double widest = std::numeric_limits<double>::infinity();  // how far a path may move, in object units
    std::vector<uint32_t> fixed;                              // vertices that the cut must keep passing through
};

// Replaces each cut-path by a shorter one between the same cut-nodes, if the cut then still opens the mesh into a disk.
// Searches the widest band around the old path first, then narrower ones. O(paths * F) in all. We differ from the
// paper: the band may be as wide as the surface, because the disk test makes that safe.
CutEdges straighten_cut(const Mesh& mesh, const Topology& topology, const CutEdges& cut,
                        const StraightenOptions& options = {});

// Exchanges cut-paths for shorter ones whose ends may lie elsewhere. If a path that does not dangle is removed, the
// opened surface becomes an annulus. The shortest path between its two boundary loops makes it a disk again. Repeats
// until nothing is gained. The cut must open the mesh into a disk, and still does so afterwards.
// O(passes * paths * F log F): meant for coarse meshes.
CutEdges shorten_cut(const Mesh& mesh, const Topology& topology, const CutEdges& cut);

// Adds a path of half-edges to the cut (value 1) or removes it (value 0).
void mark_path(const Topology& topology, const std::vector<uint32_t>& half_edges, uint8_t value, CutEdges& cut);

// Returns the sum of the lengths of the cut's edges, without input boundaries.
double cut_length(const Mesh& mesh, const Topology& topology, const CutEdges& cut);

}  // namespace gim

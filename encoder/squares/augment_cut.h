// Finds the cut: starts with an initial cut and extends it, path by path, to the extrema of the surface.
//
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3.2, "Iterated cut augmentation". We differ in three
// ways. First, the search runs on a coarse version of the surface, where a parametrization takes a tenth of a second.
// The vertex splits of the progressive mesh then carry the cut to the full mesh exactly, edge by edge, and it is
// straightened there. Second, on closed surfaces of genus 0 the two bootstrap edges are dropped once two extrema are
// known: the path between them is the cut. Third, the search goes a few steps beyond the first augmentation that does
// not help, and may ask a cut-path for more than a mere gain.
#pragma once

#include <vector>

#include "encoder/squares/boundary_map.h"
#include "encoder/squares/cut.h"
#include "encoder/surface/progressive_mesh.h"
#include "gim/encoder.h"

namespace gim {

// Vertices of the coarse mesh. More vertices show finer extrema and take more time.
inline constexpr uint32_t kSearchVertices = 3000;

struct AugmentOptions {
    BoundaryMapOptions boundary;  // of the final image; the search judges maps to the same square
    uint32_t seeds = 6;           // initial cuts tried
    uint32_t most_paths = 40;     // most augmentations
    uint32_t patience = 3;        // the search gives up after this many augmentations without gain
    double path_cost = 0;         // least gain of a cut-path, in the logarithm of stretch efficiency
};

// One state of the search, for reports and pictures.
struct AugmentStep {
    double efficiency = 0;      // stretch efficiency of the coarse map
    uint32_t extremum = kNone;  // vertex of the input mesh that this step reached
    CutEdges cut;               // cut of the coarse mesh after this step
};

struct FoundCut {
    CutEdges cut;  // opens the input mesh into a disk
    std::vector<AugmentStep> steps;
    Mesh searched;  // the coarse mesh
};

// The surface that the search runs on. Several searches may share it. O(V log V).
struct CoarseSurface {
    ProgressiveMesh hierarchy;
    ProgressiveMesh::Compacted compacted;
    Topology topology;  // of the compacted mesh
};
CoarseSurface coarsen(const Mesh& mesh, uint32_t vertices);

// `coarse` must be made from the same mesh.
Result<FoundCut> find_cut(const Mesh& mesh, const Topology& topology, const CoarseSurface& coarse,
                          const AugmentOptions& options, const Progress& progress = {});

}  // namespace gim

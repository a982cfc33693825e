// Finds the cut: the initial one, then iterated augmentation towards the extrema of the surface.
//
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3.2, "Iterated cut augmentation". We differ in three
// ways. The search runs on a coarse version of the surface, where a parametrization takes a tenth of a second; the cut
// is then carried to the full mesh exactly, edge by edge, as the vertex splits of the progressive mesh are made, and
// straightened there. On closed surfaces of genus 0 the two bootstrap edges are dropped once two extrema are known: the
// path between them is the cut. And the search looks a few steps past the first augmentation that does not help, and may ask of a
// cut-path more than that.
#pragma once

#include <vector>

#include "encoder/squares/boundary_map.h"
#include "encoder/squares/cut.h"
#include "encoder/surface/progressive_mesh.h"
#include "gim/encoder.h"

namespace gim {

inline constexpr uint32_t kSearchVertices =
    3000;  // of the mesh searched on; more see finer extrema, time grows with them

struct AugmentOptions {
    BoundaryMapOptions boundary;  // of the final image: the search judges maps to the same square
    uint32_t seeds = 6;           // initial cuts tried
    uint32_t most_paths = 40;     // augmentations at most
    uint32_t patience = 3;        // augmentations without gain before giving up
    double path_cost = 0;         // a cut-path must raise the logarithm of stretch efficiency by this to be worth it
};

// One state of the search, for reports and pictures.
struct AugmentStep {
    double efficiency = 0;      // stretch efficiency of the coarse map
    uint32_t extremum = kNone;  // vertex of the input mesh that this step reached
    CutEdges cut;               // the cut after it, of the mesh searched on
};

struct FoundCut {
    CutEdges cut;  // of the input mesh; opens it into a disk
    std::vector<AugmentStep> steps;
    Mesh searched;  // the coarse mesh
};

// What the search runs on; made once for several searches. O(V log V).
struct CoarseSurface {
    ProgressiveMesh hierarchy;
    ProgressiveMesh::Compacted compacted;
    Topology topology;  // of the compacted mesh
};
CoarseSurface coarsen(const Mesh& mesh, uint32_t vertices);

// coarse: of the same mesh.
Result<FoundCut> find_cut(const Mesh& mesh, const Topology& topology, const CoarseSurface& coarse,
                          const AugmentOptions& options, const Progress& progress = {});

}  // namespace gim

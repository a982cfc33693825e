// One connected surface -> one geometry image: the stages of Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002, in order.
#pragma once

#include <cstdint>

#include "encoder/base/stage_clock.h"
#include "encoder/squares/augment_cut.h"
#include "encoder/squares/boundary_map.h"
#include "encoder/squares/square_image.h"
#include "gim/encoder.h"

namespace gim {

// What decides between cuts and their maps; which is best for coding differs from surface to surface.
struct CutPreference {
    double most_excess =
        0.1;  // BoundaryMapOptions: cut-nodes on a coarse grid, or each cut-path at its share of the boundary
    double path_cost = 0.003;  // AugmentOptions: few cut-paths, or little stretch
    uint32_t least_units = 1;  // BoundaryMapOptions: short cut-paths at their shares, or with room

    friend bool operator==(const CutPreference&, const CutPreference&) = default;
};

struct SingleChart {
    SquareImage image;
    double cut_length = 0;           // object units
    double stretch_efficiency = 0;   // of the parametrization that was sampled
    uint64_t flipped_triangles = 0;  // in it; 0 by construction, counted all the same
    uint64_t folds = 0;              // image faces that look away from the surface
    uint64_t folds_before_fit = 0;
};

// A clean connected mesh made ready for cuts, of which several may be tried.
struct CuttableSurface {
    Mesh mesh;  // large faces split
    Topology topology;
    CoarseSurface coarse;
};
CuttableSurface make_cuttable(const Mesh& mesh, uint32_t side);

// One that is cut open, its boundary on that of the square.
struct CutSurface {
    SquareBoundary boundary;
    double cut_length = 0;  // object units
};
Result<CutSurface> cut_open(const CuttableSurface& surface, const EncodeOptions& options,
                            const CutPreference& preference, const Progress& progress = {},
                            const Observer& observer = {});

// The rest. `mesh`: the surface as it came. `clock` takes the time of each stage, `observer` the states on the way.
Result<SingleChart> map_and_sample(const CutSurface& cut, const Mesh& mesh, const EncodeOptions& options,
                                   StageClock& clock, const Observer& observer = {});

// All in a row. In: a clean connected mesh.
Result<SingleChart> make_geometry_image(const Mesh& mesh, const EncodeOptions& options, const CutPreference& preference,
                                        StageClock& clock, const Observer& observer = {});

}  // namespace gim

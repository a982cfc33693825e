// One connected surface -> one geometry image: the stages of Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002, in order.
#pragma once

#include <cstdint>

#include "encoder/geometry_image.h"
#include "encoder/stage_clock.h"
#include "gim/encoder.h"

namespace gim {

// What decides between cuts and their maps; which is best for coding differs from surface to surface.
struct CutPreference {
    double most_excess = 0.1;  // BoundaryMapOptions: cut-nodes on a coarse grid, or each cut-path at its share of the boundary
    double path_cost = 0.003;  // AugmentOptions: few cut-paths, or little stretch

    friend bool operator==(const CutPreference&, const CutPreference&) = default;
};

struct SingleChart {
    GeometryImage image;
    double cut_length = 0;           // object units
    double stretch_efficiency = 0;   // of the parametrization that was sampled
    uint64_t flipped_triangles = 0;  // in it; 0 by construction, counted all the same
    uint64_t folds = 0;              // image faces that look away from the surface
    uint64_t folds_before_fit = 0;
};

// In: a clean connected mesh. `clock` takes the time of each stage, `observer` the states on the way.
Result<SingleChart> make_geometry_image(const Mesh& mesh, const EncodeOptions& options,
                                        const CutPreference& preference, StageClock& clock, const Observer& observer = {});

}  // namespace gim

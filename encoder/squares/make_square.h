// Turns one connected surface into one geometry image. Runs these stages in order:
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002.
#pragma once

#include <cstdint>

#include "encoder/base/stage_clock.h"
#include "encoder/squares/augment_cut.h"
#include "encoder/squares/boundary_map.h"
#include "encoder/squares/square_image.h"
#include "gim/encoder.h"

namespace gim {

// Decides between cuts and their maps. Which preference codes best differs from surface to surface.
struct CutPreference {
    // BoundaryMapOptions. High: cut-nodes lie on a coarse grid. Low: each cut-path gets its share of the boundary.
    double most_excess = 0.1;
    double path_cost = 0.003;  // AugmentOptions. High: few cut-paths. Low: little stretch.
    uint32_t least_units = 1;  // BoundaryMapOptions. 1: short cut-paths get their shares. More: they get room.

    friend bool operator==(const CutPreference&, const CutPreference&) = default;
};

struct MadeSquare {
    SquareImage image;
    double cut_length = 0;           // object units
    double stretch_efficiency = 0;   // of the parametrization that was sampled
    uint64_t flipped_triangles = 0;  // in that parametrization; 0 by construction, counted as a check
    uint64_t folds_before_fit = 0;   // faces of the sampled image that look away from the surface; 0 without fit
};

// A clean connected mesh, prepared for cutting. Several cuts may be tried on it.
struct CuttableSurface {
    Mesh mesh;  // coarsened if the samples are fitted to the codec, then with large faces split
    Topology topology;
    CoarseSurface coarse;
};
CuttableSurface make_cuttable(const Mesh& mesh, const EncodeOptions& options);

// A surface that is cut open. Its boundary lies on that of the square.
struct CutSurface {
    SquareBoundary boundary;
    double cut_length = 0;  // object units
};
Result<CutSurface> cut_open(const CuttableSurface& surface, const EncodeOptions& options,
                            const CutPreference& preference, const Progress& progress = {},
                            const Observer& observer = {});

// Runs the stages after the cut. `mesh` is the surface before make_cuttable(). `clock` takes the time of each stage,
// `observer` gets the states on the way.
Result<MadeSquare> map_and_sample(const CutSurface& cut, const Mesh& mesh, const EncodeOptions& options,
                                  StageClock& clock, const Observer& observer = {});

// Runs all stages. `mesh` must be clean and connected.
Result<MadeSquare> make_square(const Mesh& mesh, const EncodeOptions& options, const CutPreference& preference,
                               StageClock& clock, const Observer& observer = {});

}  // namespace gim

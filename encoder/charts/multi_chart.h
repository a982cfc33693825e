// Runs the stages of the multi-chart layout: from a clean mesh to a zippered image.
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.
#pragma once

#include <cstdint>
#include <optional>

#include "encoder/base/stage_clock.h"
#include "encoder/charts/chart_levels.h"
#include "encoder/charts/multi_chart_image.h"
#include "encoder/fit/fit.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

struct MultiChartOptions {
    uint32_t charts = 0;          // wanted; 0: automatic; more come out if topology or flattening needs them
    uint32_t samples = 66049;     // bound on width * height
    bool density = true;          // samples are denser where the surface needs it; false: even
    uint32_t pack_effort = 30;    // more rounds of search pack more tightly; time grows with them
    uint32_t most_packings = 10;  // attempts before too few samples are an Error
    bool even_axes = false;       // makes charts of the surface as even_axes.h maps it; for long and for flat surfaces
    std::optional<FitOptions::Strength> fit = FitOptions::Strength::kLoose;  // empty: samples stay as taken
    uint64_t seed = 1;
    uint32_t threads = 0;  // 0: all cores; the result does not depend on it
};

// Returns how many charts to ask for. The number matters little, because charts that do not flatten are split anyway
// and density adapts (Figure 13 of the paper; here 65,000 samples and 8 to 60 charts: 0.2 dB on horse, gargoyle and
// feline). It matters in two cases. If samples are few, seams take up more of them (gargoyle, 10,000 samples: 1.8 dB
// from 10 to 40 charts). On machined parts, charts should end at creases (fandisk: 3.6 dB with 10,000 samples, 0.5 dB
// with 65,000).
uint32_t automatic_charts(const Mesh& mesh, uint32_t samples);

struct MultiChart {
    MultiChartImage image;
    std::vector<Vec3> sampled;  // the image's positions before the fit; empty without a fit
    Atlas atlas;                // what the image was made from
    Packing packing;
    TopologySummary topology;                               // of the mesh
    double stretch_efficiency = 0, packing_efficiency = 0;  // 0..1; the former of the maps that are sampled
    uint32_t packings = 1;                                  // packings made until the seams closed
    FitQuality before_fit, after_fit;                       // equal, and not measured, without a fit
};

// In:  a clean mesh with any number of components and boundaries.
// Out: an image whose reconstruction is a manifold with the components, boundary loops and genus of the mesh. Fails if
//      `samples` are too few for that, and says so.
Result<MultiChart> make_multi_chart_image(const Mesh& mesh, const MultiChartOptions& options, StageClock& clock);

}  // namespace gim

// The stages of the multi-chart layout: from a clean mesh to a zippered image.
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
    uint32_t charts = 0;        // asked for, 0: chosen; more come out where topology or flattening needs them
    uint32_t samples = 66049;   // bound on width * height
    bool density = true;        // denser where the surface needs it, not even
    uint32_t pack_effort = 30;  // more rounds of search pack more tightly; time grows with them
    std::optional<FitOptions::Strength> fit = FitOptions::Strength::kLoose;  // nothing: samples stay as taken
    uint64_t seed = 1;
    uint32_t threads = 0;  // 0: all cores; the result does not depend on it
};

// How many charts to ask for. Because charts that do not flatten are split anyway and density adapts, it matters little
// (Figure 13 of the paper, here 65,000 samples and 8 to 60 charts: 0.2 dB on horse, gargoyle and feline), except in two
// cases: with few samples, where seams take up more of them (gargoyle, 10,000 samples: 1.8 dB from 10 to 40 charts), and on
// machined parts, whose creases charts should end at (fandisk, 10,000 samples: 3.6 dB; 65,000: 0.5 dB).
uint32_t automatic_charts(const Mesh& mesh, uint32_t samples);

struct MultiChart {
    MultiChartImage image;
    std::vector<Vec3> sampled;  // its positions before the fit; empty without one
    Atlas atlas;                // what the image was made from
    Packing packing;
    TopologySummary topology;                               // of the mesh
    double stretch_efficiency = 0, packing_efficiency = 0;  // 0..1, the former of even samples
    uint32_t packings = 1;                                  // how many it took to get one whose seams close
    FitQuality before_fit, after_fit;                       // the same, and not measured, without a fit
};

// In:  a clean mesh, of any number of components and boundaries. Out: an image whose reconstruction is a manifold with
//      the components, boundary loops and genus of the mesh. Fails, and says so, where `samples` are too few for that.
Result<MultiChart> make_multi_chart_image(const Mesh& mesh, const MultiChartOptions& options, StageClock& clock);

}  // namespace gim

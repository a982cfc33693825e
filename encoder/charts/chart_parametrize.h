// Flattens charts with free borders at the least L2 geometric stretch, and scales them relative to each other.
//
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.2; the metric is that of
// Sander, Snyder, Gortler, Hoppe. Texture Mapping Progressive Meshes. SIGGRAPH 2001 (stretch.h).
//
// If a map is enlarged by s, its stretch E falls as 1/s^2. So a free border minimises E times the map's area A. We
// minimise E + A instead, summed over the triangles. At the best scale E = A, and the sum is twice the root of the
// least E * A. The sum over all charts is least if each chart is at its own best scale. So each chart is solved by
// itself and comes out at its right relative size. The energy grows without bound as a triangle collapses, so no
// triangle flips.
//
// We differ from the paper in the solver. The paper goes from coarse to fine, vertex by vertex. We use Newton's method
// on a whole chart, with one sparse factorization per step. The Hessian of each triangle is made positive: its
// eigensystem in the singular values is known in closed form (Smith, de Goes, Kim. Analytic Eigensystems for Isotropic
// Distortion Energies. ACM TOG 2019). We start from the projection along the chart's mean normal if that is upright,
// else from Tutte's map to a circle.
//
// If the border would cross itself, the chart is solved again from the circle. A barrier then acts between border
// vertices and border edges that come close.
//
// Cost: 5 to 30 sparse factorizations per chart. Deterministic at any thread count.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/charts/border_barrier.h"
#include "encoder/charts/chart_set.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

struct ChartParametrizeOptions {
    int most_steps = 200;     // most Newton steps per chart; 10 to 30 are usual
    double tolerance = 1e-4;  // stops when a step gains less than this part of the energy
    uint32_t threads = 0;     // 0: all cores; the result does not depend on it
};

struct ChartMap {
    std::vector<Vec2> uv;  // per vertex of the chart's mesh, in object units; every triangle is counter-clockwise, and
                           // the border does not touch itself (unless `overlaps`)
    double energy = 0;     // integral of the squared stretch over the surface (times importance)
    double area = 0;       // of the map
    double surface = 0;    // area on the surface
    // The chart must be split: its border touches itself even with the barrier, or a triangle is not upright.
    bool overlaps = false;
    // Two faces of the chart whose borders would cross without the barrier. In charts apart they would flatten better.
    // The map is the best one without overlap that was found. `strain` (1 or more) is its E * A relative to the map
    // with overlap.
    std::optional<std::array<uint32_t, 2>> crossing;
    double strain = 1;

    double efficiency() const { return surface * surface / (energy * area); }  // 0..1, exact if importance is 1
};

// Flattens one chart, which must be a disk. `importance` per face of the chart: how much more densely than others it
// should be sampled (empty: 1). Fails only if Tutte's map cannot be solved.
Result<ChartMap> parametrize_chart(const Chart& chart, const std::vector<double>& importance,
                                   const ChartParametrizeOptions& options);

// Measures the map's energy and area again.
void measure_map(const Chart& chart, const std::vector<double>& importance, ChartMap& map);

// Scales a measured map to its right size relative to other charts.
void scale_best(ChartMap& map);

// Continues from an upright map, with a force on its border. The energy counts the map's area `area_weight` times.
// Below 1 the chart presses outwards into free room. Never flips a triangle. The force must keep the border from
// crossing itself.
ChartMap relax_chart(const Chart& chart, const std::vector<double>& importance, ChartMap map, double area_weight,
                     const BorderForce& force, const ChartParametrizeOptions& options);

// Flattens every chart. `importance` per face of the surface (empty: 1).
Result<std::vector<ChartMap>> parametrize_charts(const std::vector<Chart>& charts,
                                                 const std::vector<double>& importance,
                                                 const ChartParametrizeOptions& options, const Progress& progress = {});

// Returns 1 / (normalised L2 stretch)^2 over all charts together, 0..1. The domain is the area of the maps. Empty space
// between charts does not count; it belongs to the packing.
double stretch_efficiency(const std::vector<Chart>& charts, const std::vector<ChartMap>& maps);

// Returns a chart's border in its map. It starts at the chart's first cut-node.
std::vector<Vec2> border_of(const Chart& chart, const std::vector<Vec2>& uv);

}  // namespace gim

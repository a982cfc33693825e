// Flattens charts with free borders at the least L2 geometric stretch, and scales them relative to each other.
//
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.2; the metric is that of
// Sander, Snyder, Gortler, Hoppe. Texture Mapping Progressive Meshes. SIGGRAPH 2001 (stretch.h).
//
// The stretch E of a chart falls as 1/s^2 when its map is enlarged by s, so what a free border minimises is E times the
// map's area A. We minimise E + A instead, summed over the triangles: at the best scale E = A, and the sum's least
// value is then twice the root of the least E * A. The same sum over all charts is least when each is at its own best
// scale, so charts are solved apart and come out in the right relative sizes. A triangle that flattens costs without
// bound: nothing flips.
//
// We differ from the paper in the solver: not coarse to fine vertex by vertex, but Newton's method on a whole chart
// with per-triangle Hessians made positive (their eigensystem in the singular values is known in closed form: Smith, de
// Goes, Kim. Analytic Eigensystems for Isotropic Distortion Energies. ACM TOG 2019), one sparse factorization a step,
// started from the projection along the chart's mean normal where that is upright, else from Tutte's map to a circle.
//
// A border that would run over itself is solved again from the circle, with a barrier between border vertices and
// border edges that come close.
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
    int most_steps = 200;     // Newton steps per chart, at most; 10 to 30 are usual
    double tolerance = 1e-4;  // stop when a step gains less than this part of the energy
    uint32_t threads = 0;     // 0: all cores; the result does not depend on it
};

struct ChartMap {
    std::vector<Vec2> uv;  // per vertex of the chart's mesh, object units; every triangle counter-clockwise; the border
                           // does not touch itself (unless `overlaps`)
    double energy = 0;     // integral of the squared stretch over the surface (times importance)
    double area = 0;       // of the map
    double surface = 0;    // area on the surface
    bool overlaps =
        false;  // not even the slow way found a border that keeps clear of itself, or triangles could not be
                // kept upright: split the chart
    // Two faces of the chart whose borders would run into each other if they could. The map is then the best without
    // overlap that was found, `strain` (1 or more) how much worse than with it; apart, the two would flatten better.
    std::optional<std::array<uint32_t, 2>> crossing;
    double strain = 1;

    double efficiency() const { return surface * surface / (energy * area); }  // 0..1, exact where importance is 1
};

// One map. `importance` per face of the chart: how much more densely than others it should be sampled (empty: 1).
// Fails only when not even Tutte's map can be solved. In: a disk.
Result<ChartMap> parametrize_chart(const Chart& chart, const std::vector<double>& importance,
                                   const ChartParametrizeOptions& options);

// Takes the map's energy and area anew.
void measure_map(const Chart& chart, const std::vector<double>& importance, ChartMap& map);

// Goes on from a map that is upright: the energy with the chart's area counting `area_weight` times what it takes up, and
// a force on its border. With less than 1 the chart presses outwards, as there is room to be had. Never flips a triangle;
// a crossing of the border with itself is the force's affair.
ChartMap relax_chart(const Chart& chart, const std::vector<double>& importance, ChartMap map, double area_weight,
                     const BorderForce& force, const ChartParametrizeOptions& options);

// Every chart. `importance` per face of the surface (empty: 1).
Result<std::vector<ChartMap>> parametrize_charts(const std::vector<Chart>& charts,
                                                 const std::vector<double>& importance,
                                                 const ChartParametrizeOptions& options, const Progress& progress = {});

// 1 / (normalised L2 stretch)^2 over all charts together, 0..1, with the area of the maps as the domain (empty space
// between charts is the packing's affair).
double stretch_efficiency(const std::vector<Chart>& charts, const std::vector<ChartMap>& maps);

// A chart's border in its map, from its first cut-node on.
std::vector<Vec2> border_of(const Chart& chart, const std::vector<Vec2>& uv);

}  // namespace gim

// Partitions a surface into charts: compact, nearly flat topological disks whose borders follow the creases.
//
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.1: Lloyd-Max clustering of
// faces. Phase 1 grows charts from seed faces over the dual graph. Phase 2 moves each seed to the face farthest from
// its chart's border. Both alternate until the seeds repeat.
//
// We differ from the paper: (1) Bootstrapping adds several seeds per round (a fifth of those present), which saves most
// of the rounds. (2) A face that no chart may take becomes a seed at once, so every round ends with all faces assigned.
// (3) Topology may force more charts than were asked for. Two of them are merged again if they make one disk. (4)
// Borders are straightened at the end: a single face changes charts if that shortens the border. (5) Crossing a crease
// costs extra. So charts may be round (a larger lambda) and still end at creases.
//
// In:  an oriented 2-manifold with any number of components and boundaries.
// Out: charts, each a disk whose border is a simple loop (it does not touch itself, not even at a vertex).
// Cost: O(rounds * F log F), about 40 ms a round for 100,000 faces. Deterministic for a seed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

struct ChartifyOptions {
    uint32_t charts = 25;    // wanted; more come out if topology needs them (two per closed component, handles)
    uint64_t seed = 1;       // chooses the first seed face
    double planarity = 2.0;  // the paper's lambda (there 1); larger: rounder, less flat charts, which pack more tightly
    int most_rounds = 60;    // most Lloyd rounds after bootstrapping; 10 to 30 usually suffice
};

struct Chartification {
    std::vector<uint32_t> chart_of_face;
    uint32_t count = 0;
};

// Never fails on a 2-manifold: in the worst case faces become charts of their own.
Chartification chartify(const Mesh& mesh, const Topology& topology, const ChartifyOptions& options);

// Splits one chart in two, or in more if topology needs it. Use it for charts that do not flatten. The parts grow from
// the faces `seeds` (kNone: from two far ends of the chart). New charts get the highest numbers. The other charts stay,
// and so does a chart of a single face.
void split_chart(const Mesh& mesh, const Topology& topology, uint32_t chart, std::array<uint32_t, 2> seeds,
                 Chartification& charts);

// Measures how far the charts are from flat. Returns the area-weighted mean of 1 - cos(angle between a face's normal
// and its chart's mean normal).
double mean_normal_deviation(const Mesh& mesh, const Chartification& charts);

// Returns whether the faces of every chart form a disk with a simple border. chartify() promises this. Tests and
// callers with partitions of their own can check it.
bool charts_are_disks(const Mesh& mesh, const Topology& topology, const Chartification& charts);

}  // namespace gim

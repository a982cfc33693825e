// Partitions a surface into charts: compact, nearly flat topological disks whose borders follow the creases.
//
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.1: Lloyd-Max clustering of
// faces. Phase 1 grows charts from seed faces over the dual graph, phase 2 moves each seed to the face farthest from
// its chart's border, until the seeds repeat.
//
// We differ: (1) while bootstrapping, several seeds are added per round (a fifth of those present), which saves most of
// the rounds; (2) a face that no chart may take becomes a seed on the spot, so that every round ends with all faces
// assigned; (3) charts forced on us beyond the number asked for are merged again where two make one disk; (4) borders
// are straightened at the end by handing single faces over wherever that shortens the border; (5) crossing a crease costs
// extra, so that charts may be round (a larger lambda) and still end at creases.
//
// In:  an oriented 2-manifold, any number of components and boundaries. Every chart that comes out is a disk whose
//      border is a simple loop (it does not touch itself, not even at a vertex).
// Cost: O(rounds * F log F), about 40 ms a round for 100,000 faces. Deterministic for a seed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

struct ChartifyOptions {
    uint32_t charts = 25;    // asked for; more come out where topology needs them (two per closed component, handles)
    uint64_t seed = 1;       // chooses the first seed face
    double planarity = 2.0;  // the paper's lambda, there 1: larger = rounder, less flat charts, which pack more tightly
    int most_rounds = 60;    // Lloyd rounds after bootstrapping, at most; usually 10 to 30 suffice
};

struct Chartification {
    std::vector<uint32_t> chart_of_face;
    uint32_t count = 0;
};

// Never fails on a 2-manifold: in the worst case faces become charts of their own.
Chartification chartify(const Mesh& mesh, const Topology& topology, const ChartifyOptions& options);

// Splits one chart in two, leaving the others as they are; the new chart (or charts) get the highest numbers. For charts
// that turn out not to flatten. The two parts grow from the faces `seeds` (kNone: from two far ends of the chart). A chart
// of a single face stays.
void split_chart(const Mesh& mesh, const Topology& topology, uint32_t chart, std::array<uint32_t, 2> seeds,
                 Chartification& charts);

// How far the charts are from flat: the area-weighted mean of 1 - cos(angle between a face and its chart's mean
// normal).
double mean_normal_deviation(const Mesh& mesh, const Chartification& charts);

// Whether the faces of every chart form a disk with a simple border. The promise of chartify(), for tests and callers
// with partitions of their own.
bool charts_are_disks(const Mesh& mesh, const Topology& topology, const Chartification& charts);

}  // namespace gim

// A multi-chart image as a file holds it: every chart an image of its own, and its border at every level.
//
// After: Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Sections 4.4 and 4.5, applied once
// more at each coarser scale. The paper has no levels of detail: packed charts lie a sample apart, so that coarser they
// would run into each other. In boxes of their own they cannot. Each level has its own rasterisation of the charts and its
// own zipper, and is kept only if its surface has the mesh's topology.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/charts/atlas.h"
#include "encoder/charts/multi_chart_image.h"
#include "encoder/charts/pack.h"
#include "encoder/surface/topology_summary.h"
#include "format/chart_table.h"

namespace gim {

// The borders of one level.
struct LevelBorders {
    std::vector<std::vector<uint32_t>> loops;  // per chart: border samples as row * columns + column of its box at this
                                               // level, from the first path's begin node on
    std::vector<uint32_t> lengths;             // per path
    std::vector<std::vector<ZipStep>> zippers;  // as in SeamRecord
    LevelSize size;
};

struct ChartLevels {
    MultiChartImage image;  // the charts in their rectangle
    std::vector<ChartBox> charts;
    std::vector<uint32_t> mates;                // per path, chart after chart
    std::vector<std::vector<Vec3>> positions;   // per chart, its box row by row; zero where undefined
    std::vector<std::vector<uint8_t>> defined;  // per chart, likewise
    std::vector<LevelBorders> levels;           // finest first; at least one

    uint64_t defined_count() const;
    uint64_t sample_count() const { return uint64_t{image.width()} * image.height(); }
};

// In:  the finished image, what it was made from, and the topology that every level must have.
// Out: as many levels as have it, `most_levels` at most. Fails when not even the finest has.
Result<ChartLevels> make_chart_levels(const MultiChartImage& image, const Atlas& atlas, const Packing& packing,
                                      const TopologySummary& wanted, uint32_t most_levels, uint32_t threads);

bool same_topology(const TopologySummary& a, const TopologySummary& b);

}  // namespace gim

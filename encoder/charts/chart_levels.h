// A multi-chart image as a file holds it: every chart is an image of its own, with its border at every level.
//
// After: Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Sections 4.4 and 4.5, applied
// again at each coarser scale. The paper has no levels of detail: its packed charts lie a sample apart and would run
// into each other on coarser levels. Charts in boxes of their own cannot. Each level has its own rasterisation of the
// charts and its own zippers. A level is kept only if its surface has the mesh's topology.
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
    std::vector<std::vector<uint32_t>> loops;  // per chart: its border samples, as row * columns + column in its box at
                                               // this level; starts at the first path's begin node
    std::vector<uint32_t> lengths;             // per path
    std::vector<std::vector<ZipStep>> zippers;  // as in SeamRecord
    LevelSize size;
};

struct ChartLevels {
    MultiChartImage image;  // the charts in their rectangle
    std::vector<ChartBox> charts;
    std::vector<uint32_t> mates;                // per path, chart after chart
    std::vector<std::vector<Vec3>> positions;   // per chart, its box row by row
    std::vector<std::vector<uint8_t>> defined;  // per chart, in the same order
    bool is_extended = false;                   // positions where undefined: false: zero; true: cheap to code
    std::vector<LevelBorders> levels;           // finest first; at least one

    uint64_t defined_count() const;
    uint64_t sample_count() const { return uint64_t{image.width()} * image.height(); }
};

// In:  the finished image, what it was made from, and the topology that every level must have.
// Out: levels from the finest to the coarsest one with that topology, at most `most_levels`. The image itself is the
//      finest and is not checked. Fails if its seam record does not fit its mask.
Result<ChartLevels> make_chart_levels(const MultiChartImage& image, const Atlas& atlas, const Packing& packing,
                                      const TopologySummary& wanted, uint32_t most_levels, uint32_t threads);

bool same_topology(const TopologySummary& a, const TopologySummary& b);

}  // namespace gim

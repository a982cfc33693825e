// Packs charts into the smallest-waste rectangle: bitmaps, many orientations, a search over rectangles and scales.
//
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.3. We differ: a chart may go
// anywhere that is free, not only onto the horizon of those before it; all positions of a row are tried at once, 64 to a
// machine word; the packings so made are only the start for squeeze(), which lets charts overlap on the way to a smaller
// rectangle; and the scale is refined far below 1 %.
//
// Gutter: no sample of a chart has a sample of another chart as its neighbour in the same row or column. Diagonal
// neighbours are allowed: the 2 x 2 quad between them has only those two samples, and two make no triangle (section 3 of
// the paper).
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/charts/chart_mask.h"
#include "gim/encoder.h"

namespace gim {

struct PackOptions {
    uint32_t most_samples = 66049;  // bound on width * height
    uint32_t orientations = 32;     // evenly spread; more fit a little tighter, time grows with them
    double most_aspect = 4;         // longer side over shorter side stays below this
    uint32_t effort = 30;           // more finds denser packings, in time about in proportion
    uint64_t seed = 1;
    uint32_t threads = 0;  // 0: all cores; the result does not depend on it
};

// What is packed: a chart's border in its map and the least number of border samples it needs.
struct PackShape {
    std::vector<Vec2> border;
    uint32_t least_border = 3;
    double magnification = 1;  // relative to the other charts
};

struct PlacedChart {
    ChartMask chart;               // as rasterized; chart.pose is into the image
    uint32_t column = 0, row = 0;  // where the mask's first sample lies in the image
};

struct Packing {
    uint32_t width = 0, height = 0;
    double scale = 0;  // samples per object unit
    std::vector<PlacedChart> charts;
    uint64_t defined = 0;          // samples
    std::vector<uint32_t> broken;  // not empty: these charts have to be split first, and nothing was packed
    double efficiency() const { return static_cast<double>(defined) / (static_cast<double>(width) * height); }
};

// Per sample of the rectangle, row-major: the chart that defines it, or kNone. O(samples).
std::vector<uint32_t> owners_of(const Packing& packing);

// Every placed mask is a disk with at least `least_border` border samples. A chart for which no orientation gives one is
// enlarged on its own; when its masks are still no disks at 1.8 times its size it is reported in `broken`: it has an
// inlet narrower than a sample. So is one that is much longer than the side of a square of the samples. Fails when the
// bound is too small for the charts.
// Cost: a few seconds for 50 charts and 65,536 samples. Deterministic.
Result<Packing> pack(const std::vector<PackShape>& shapes, const PackOptions& options, const Progress& progress = {});

}  // namespace gim

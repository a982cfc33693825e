// Packs charts into the rectangle with the least waste. Charts are bitmaps in many orientations. The search goes over
// rectangles and scales.
//
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.3. We differ from the paper: A
// chart may go anywhere that is free, not only onto the horizon of the charts before it. All positions of a row are
// tried at once, 64 in a machine word. These packings are only the start for squeeze(), which lets charts overlap on
// the way to a smaller rectangle. The scale is refined far below 1 %.
//
// Gutter: no sample of a chart has a sample of another chart as its neighbour in the same row or column. Diagonal
// neighbours are allowed: the 2 x 2 quad between them has only those two samples, and two make no triangle (section 3
// of the paper).
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/charts/chart_mask.h"
#include "gim/encoder.h"

namespace gim {

struct PackOptions {
    uint32_t most_samples = 66049;  // bound on width * height
    uint32_t orientations = 32;     // evenly spread; more fit a little tighter and take more time
    double most_aspect = 4;         // longer side over shorter side stays below this
    uint32_t effort = 30;           // more finds denser packings; time grows about in proportion
    uint64_t seed = 1;
    uint32_t threads = 0;  // 0: all cores; the result does not depend on it
};

// A chart to pack: its border in its map, and the least number of border samples it needs.
struct PackShape {
    std::vector<Vec2> border;
    uint32_t least_border = 3;
    double magnification = 1;  // relative to the other charts
};

struct PlacedChart {
    ChartMask chart;               // as rasterized, but chart.pose leads to the image
    uint32_t column = 0, row = 0;  // where the mask's first sample lies in the image
};

struct Packing {
    uint32_t width = 0, height = 0;
    double scale = 0;  // samples per object unit
    std::vector<PlacedChart> charts;
    uint64_t defined = 0;          // samples
    std::vector<uint32_t> broken;  // if not empty, nothing was packed: these charts have to be split first
    double efficiency() const { return static_cast<double>(defined) / (static_cast<double>(width) * height); }
};

// Returns the chart that defines each sample of the rectangle (row-major), or kNone. O(samples).
std::vector<uint32_t> owners_of(const Packing& packing);

// Packs charts. Every placed mask is a disk with at least `least_border` border samples. If no orientation of a chart
// gives such a mask, that chart alone is enlarged. If its masks are still no disks at 1.8 times its size, it has an
// inlet narrower than a sample and is reported in `broken`. A chart much longer than the side of a square of all
// samples is reported too. Fails if the bound is too small for the charts.
// Cost: a few seconds for 50 charts and 65,536 samples. Deterministic.
Result<Packing> pack(const std::vector<PackShape>& shapes, const PackOptions& options, const Progress& progress = {});

}  // namespace gim

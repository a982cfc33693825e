// Takes positions from the surface for every defined sample of the packed charts.
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.4.
//
// A sample inside the chart's map gets the surface point under it. A sample outside (border band, dilation) gets the
// closest point of the border. We differ from the paper: a dilated sample gets its own point on the border, not a copy
// of its neighbour's.
#pragma once

#include <vector>

#include "encoder/charts/chart_parametrize.h"
#include "encoder/charts/chart_set.h"
#include "encoder/charts/multi_chart_image.h"
#include "encoder/charts/pack.h"

namespace gim {

// Returns the image without seams, every chart by itself. In: charts, their maps and where they are packed. O(samples +
// faces + border samples * border edges).
MultiChartImage sample_charts(const std::vector<Chart>& charts, const std::vector<ChartMap>& maps,
                              const Packing& packing, uint32_t threads = 0);

}  // namespace gim

// Takes positions from the surface for every defined sample of the packed charts.
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.4.
//
// A sample inside the chart's map gets the surface point under it; a sample outside (border band, dilation) that of the
// closest point of the border. We differ from the paper in that dilated samples too get a point of their own on the border
// instead of a copy of their neighbour's.
#pragma once

#include <vector>

#include "encoder/charts/chart_parametrize.h"
#include "encoder/charts/chart_set.h"
#include "encoder/charts/multi_chart_image.h"
#include "encoder/charts/pack.h"

namespace gim {

// The image without seams, every chart by itself. In: charts, their maps and where they are packed. O(samples + faces + border samples * border
// edges).
MultiChartImage sample_charts(const std::vector<Chart>& charts, const std::vector<ChartMap>& maps,
                              const Packing& packing, uint32_t threads = 0);

}  // namespace gim

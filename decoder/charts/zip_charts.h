// Reads the borders of charts and zips them: tells which samples are one surface point.
// After: Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.5.
#pragma once

#include "decoder/charts/chart_decoder.h"

namespace gim {

// Reads the borders and zippers of stream_level. Those of the coarser levels were read before, unless it is the coarsest
// one. If that is the requested level, also fills ws.depth and makes ws.point a forest over the border samples, by flat
// index, in which parents come before their children. Those of other samples are not set. Returns false on borders that
// no encoder writes.
bool read_borders(const ChartLevelShape& shape, const ChartWorkspace& ws, uint32_t stream_level, bool is_coarsest,
                  RangeDecoder& decoder);

// Turns the forest into vertex numbers, by first appearance. Returns how many there are.
uint32_t number_points(const ChartLevelShape& shape, const ChartWorkspace& ws);

}  // namespace gim

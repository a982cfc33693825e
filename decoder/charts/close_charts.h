// Closes the seams between charts and makes the corrections fade out into them.  spec/gim-format.md, "Charts".
// After: Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.5.
#pragma once

#include "decoder/charts/chart_decoder.h"

namespace gim {

// samples: flat triples. ws.point holds vertex numbers. If anything changes, ws.depth afterwards counts the layers that
// got a part.
void close_charts(const ChartLevelShape& shape, const ChartWorkspace& ws, float* samples);

}  // namespace gim

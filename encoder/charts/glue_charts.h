// Glues packed charts into a geometry image. Mask and seam record say which samples are one surface point.
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.5 (zippering).
#pragma once

#include "encoder/base/result.h"
#include "encoder/charts/multi_chart_image.h"
#include "encoder/image/gluing.h"

namespace gim {

// Fails when the record does not fit the mask. O(samples).
Result<GridGluing> glue_charts(const SampleMask& mask, const SeamRecord& seams);

// Returns the gluing of charts that stand alone, with open borders.
GridGluing glue_nothing(const SampleMask& mask);

}  // namespace gim

// Closes the seams of a packed image as the decoder does: every surface point becomes the mean of its samples, and the
// corrections fade out into the charts (format/chart_ramp.h).
#pragma once

#include <vector>

#include "encoder/charts/chart_levels.h"

namespace gim {

// image: interleaved triples of the samples of charts.image. O(samples).
void close_chart_seams(const ChartLevels& charts, std::vector<float>& image);

}  // namespace gim

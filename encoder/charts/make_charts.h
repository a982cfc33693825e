// Runs all stages of the multi-chart layout before coding: from a clean mesh to charts at all levels.
#pragma once

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/charts/chart_levels.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Adds its figures to the report (multi_chart.h). If the charts need more samples than asked.samples, doubles them a
// few times, up to `most_samples`, and warns.
Result<ChartLevels> make_charts(const Mesh& mesh, const EncodeOptions& asked, uint32_t most_samples, StageClock& clock,
                                const Observer& observer, EncodeReport& report);

}  // namespace gim

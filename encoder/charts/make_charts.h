// Runs all stages of the multi-chart layout before coding: from a clean mesh to charts at all levels.
#pragma once

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/charts/chart_levels.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Adds its figures to the report (multi_chart.h).
Result<ChartLevels> make_charts(const Mesh& mesh, const EncodeOptions& options, StageClock& clock,
                                const Observer& observer, EncodeReport& report);

}  // namespace gim

// The multi-chart layout on its way from a clean mesh to a file.
#pragma once

#include "encoder/base/stage_clock.h"
#include "encoder/charts/chart_levels.h"
#include "encoder/finish_encoding.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// All stages before coding (multi_chart.h), and the figures that they give.
Result<ChartImages> make_charts(const Mesh& mesh, const EncodeOptions& options, StageClock& clock,
                                const Observer& observer, EncodeReport& report);

// The charts must outlive the job.
CodingJob code_charts(const ChartImages& charts, EncodeReport& report);

}  // namespace gim

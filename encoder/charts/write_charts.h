// Charts as a file holds them: chart table, borders and zippers, and the levels of all charts.
// spec/gim-format.md, "Charts".
#pragma once

#include "encoder/base/result.h"
#include "encoder/charts/chart_levels.h"
#include "encoder/code/file_writer.h"

namespace gim {

// parameters.base_side does not matter: the levels are those of the charts. An Error names the chart that does not fit.
Result<FileWriter> charts_writer(const ChartLevels& images, const CodingParameters& parameters);

}  // namespace gim

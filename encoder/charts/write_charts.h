// Writes charts as a file holds them: chart table, borders and zippers, and the levels of all charts.
// spec/gim-format.md, "Charts".
#pragma once

#include "encoder/base/result.h"
#include "encoder/charts/chart_levels.h"
#include "encoder/code/file_writer.h"
#include "format/container.h"

namespace gim {

// Returns the units of a lossy file, but for its quantizer.
Units chart_units(const ChartLevels& images, uint32_t bits);

// Ignores parameters.base_side: the charts have their levels already. An Error names the chart that does not fit.
Result<FileWriter> charts_writer(const ChartLevels& images, const CodingParameters& parameters);

}  // namespace gim

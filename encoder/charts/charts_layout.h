// Offers packed charts to the drivers as the layout mcgim, ready to be coded.
#pragma once

#include <memory>

#include "encoder/charts/chart_levels.h"
#include "encoder/layout/layout_images.h"

namespace gim {

// mesh: the surface that the charts were made from. Its folds are repaired in lossy files; copied.
std::unique_ptr<LayoutImages> charts_layout(ChartLevels charts, const Mesh& mesh, const EncodeOptions& options);

}  // namespace gim

// Offers packed charts to the drivers as the layout mcgim, ready to be coded.
#pragma once

#include <memory>

#include "encoder/charts/chart_levels.h"
#include "encoder/layout/layout_images.h"

namespace gim {

std::unique_ptr<LayoutImages> charts_layout(ChartLevels charts);

}  // namespace gim

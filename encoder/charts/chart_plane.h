// Splits a plane on packed charts into bands.
#pragma once

#include <vector>

#include "encoder/planes/plane_images.h"

namespace gim {

// Returns the bands of a plane. Gives texels beyond the charts values that cost few bytes. values: a triple per texel.
Pyramid<float> analyse_chart_plane(const TexelGrid& grid, std::vector<float> values, float quantizer);

}  // namespace gim

// Finds the texels of a plane on packed charts: those that lie in a triangle. A sample step has 2^exponent texels.
#pragma once

#include <cstdint>

#include "encoder/planes/plane_images.h"

namespace gim {

// Returns the exponent with which a plane of the image comes closest to side * side texels.
uint8_t chart_plane_exponent(const GeometryImage& image, uint32_t side);

// Returns texels in the order of the triangles they lie in. A texel on an edge belongs to the first one. O(texels).
TexelGrid chart_texels(const GeometryImage& image, uint8_t exponent);

// Returns the bands of a plane. Gives texels beyond the charts values that cost few bytes. values: a triple per texel.
Pyramid<float> analyse_chart_plane(const TexelGrid& grid, std::vector<float> values, float quantizer);

}  // namespace gim

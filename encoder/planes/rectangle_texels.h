// Finds the texels of a plane on an image that is a rectangle: those that lie in a triangle. A sample step has 2^exponent
// texels.
#pragma once

#include <cstdint>

#include "encoder/planes/plane_images.h"

namespace gim {

// Returns the exponent that comes closest to so many texels a sample step. per_sample > 0.
uint8_t texel_exponent(double per_sample);

// Returns texels in the order of the triangles they lie in. A texel on an edge belongs to the first one. O(texels).
TexelGrid rectangle_texels(const GeometryImage& image, uint8_t exponent);

}  // namespace gim

// Texels of a plane on a square: a grid of its own over the same square.
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3 (attributes at their own resolution).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/planes/plane_images.h"
#include "encoder/squares/square_image.h"

namespace gim {

// Per image j of its plane's side 2^j + 1. Smaller images get smaller planes; never below the grid that their seams need.
std::vector<uint8_t> square_plane_exponents(std::span<const SquareImage> images, uint32_t side);

// All texels of a side x side plane, row-major. O(side^2).
TexelGrid square_texels(const SquareImage& image, uint32_t side);

// Values of all members of a class become those of its first one. values: side * side triples. The sideband is in order and
// its node grid not finer than the plane.
void equalize_ring(const Sideband& sideband, uint32_t side, std::vector<float>& values);

}  // namespace gim

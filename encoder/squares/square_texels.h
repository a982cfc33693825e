// Finds the texels of a plane on a square. The plane has its own grid over that square.
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3 (attributes at their own resolution).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/planes/plane_images.h"
#include "encoder/squares/square_image.h"

namespace gim {

// Returns for each image the j of its plane's side 2^j + 1. Smaller images get smaller planes, but no plane is smaller
// than the grid that its seams need.
std::vector<uint8_t> square_plane_exponents(std::span<const SquareImage> images, uint32_t side);

// Returns all texels of a side x side plane, row-major. O(side^2).
TexelGrid square_texels(const SquareImage& image, uint32_t side);

// Gives all members of a class the values of its first one. `values` holds side * side triples. The sideband must be
// valid, and its node grid no finer than the plane.
void equalize_ring(const Sideband& sideband, uint32_t side, std::vector<float>& values);

}  // namespace gim

// Planes on tiles: where their texels lie on the surface, and how they are coded. A plane is an image on the same complex
// with 2^exponent texels a sample.  spec/gim-format.md, "Tiles".
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/image/geometry_image.h"
#include "encoder/planes/plane_images.h"
#include "encoder/tiles/tile_image.h"

namespace gim {

// Returns the exponent with which all tiles together come closest to side * side texels.
uint8_t tile_plane_exponent(const TileImage& tiles, uint32_t side);

// Returns the texels of the tiles, on the rectangle of their atlas. Those on sharp edges lie a little inside their own
// tile, so that each copy shows its own side of the edge. atlas: atlas_of(tiles). O(texels).
TexelGrid tile_texels(const TileImage& tiles, const GeometryImage& atlas, uint8_t exponent);

// values: a triple per texel of the grid. Copies of a texel in several tiles get their mean. The complex must be that of a
// surface. O(texels).
PlaneCoder tile_plane_coder(const TileImage& tiles, const TexelGrid& grid, const std::vector<float>& values);

}  // namespace gim

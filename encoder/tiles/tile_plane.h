// Planes on tiles: where their texels lie on the surface, and how they are coded. A plane is an image on the same complex
// with 2^exponent texels a sample.  spec/gim-format.md, "Tiles".
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/image/geometry_image.h"
#include "encoder/planes/plane_images.h"
#include "encoder/tiles/own_complex.h"
#include "encoder/tiles/tile_image.h"
#include "format/container.h"

namespace gim {

// Returns the exponent with which all tiles together come closest to side * side texels.
uint8_t tile_plane_exponent(const TileImage& tiles, uint32_t side);

// Returns the texels of the tiles, on the rectangle of their atlas. Those on sharp edges lie a little inside their own
// tile, so that each copy shows its own side of the edge. atlas: atlas_of(tiles). O(texels).
TexelGrid tile_texels(const TileImage& tiles, const GeometryImage& atlas, uint8_t exponent);

// values: a triple per texel of the grid. Copies of a texel in several tiles get their mean. The complex must be that of a
// surface. O(texels).
PlaneCoder tile_plane_coder(const TileImage& tiles, const TexelGrid& grid, const std::vector<float>& values);

// The coder of a plane on tiles that are in the order of a file. complex: of the positions, whose shape is `shape`. grids:
// per tile (2^(shape.exponent + texels) + 1)^2 triples, row by row; copies of a texel get their mean. O(texels).
PlaneCoder tile_grid_coder(OwnComplex complex, const TileShape& shape, uint32_t texels, std::vector<float> grids);

}  // namespace gim

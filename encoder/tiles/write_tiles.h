// Writes an image of tiles as a file holds it: how the tiles are glued, and one stream for each level.
// See spec/gim-format.md.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/code/file_writer.h"
#include "encoder/tiles/tile_image.h"
#include "encoder/tiles/tile_pyramid.h"

namespace gim {

// Changes the integers of a lossy file before they are coded.
using RepairTiles = std::function<void(TilePyramid<int32_t>& pyramid, const Units& units)>;

// Positions must be finite, and the quads the base of a surface: oriented, each edge between two tiles or on a boundary,
// the tiles at a vertex one fan. Otherwise an Error names the tile. repair: lossy; empty: nothing does.
Result<FileWriter> tiles_writer(const TileImage& image, const CodingParameters& parameters, RepairTiles repair = {});
Result<std::vector<uint8_t>> write_tiles(const TileImage& image, const CodingParameters& parameters);

// Returns the shape that the header of a file has. complex: that of the image, in any order.
TileShape shape_of(const TileImage& image, const QuadComplex& complex, bool lossless);

// Returns the units of positions and details in a lossy file of the image. Leaves the quantizer out.
Result<Units> tile_units(const TileImage& image, uint32_t bits);

}  // namespace gim

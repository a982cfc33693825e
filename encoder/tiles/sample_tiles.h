// Samples a surface at the grid points of its tiles, and lays the tiles out as an image.
// Maximo, Velho, Siqueira 2014. Section 4.3.
#pragma once

#include <vector>

#include "encoder/base/result.h"
#include "encoder/image/geometry_image.h"
#include "encoder/surface/surface_point.h"
#include "encoder/tiles/locate_samples.h"
#include "encoder/tiles/tile_complex.h"
#include "encoder/tiles/tile_map.h"

namespace gim {

// Tiles in slots of a rectangle near a square, row by row. A slot has side + 1 samples a side. Column and row of a
// sample are u and v.
struct TileAtlas {
    uint32_t columns = 1, rows = 1, side = 1;

    uint32_t width() const { return columns * (side + 1); }
    uint32_t height() const { return rows * (side + 1); }
    uint32_t at(uint32_t tile, uint32_t row, uint32_t column) const {
        return (tile / columns * (side + 1) + row) * width() + tile % columns * (side + 1) + column;
    }
};
TileAtlas make_atlas(uint32_t tiles, uint32_t side);

// Says which samples of the atlas are one surface point. Slots without a tile, and cells between slots, are empty.
GridGluing glue_tiles(TileComplex& complex, const TileAtlas& atlas);

// In: a point of map.triangles for each sample (locate_samples()). Glued samples get equal bits. O(samples).
GeometryImage sample_tiles(const std::vector<Vec3>& positions, const TileMap& map, TileComplex& complex,
                           const std::vector<SurfacePoint>& points, uint32_t side);

}  // namespace gim

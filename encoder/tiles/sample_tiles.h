// Samples a surface at the grid points of its tiles, and lays tiles out as a geometry image.
// Maximo, Velho, Siqueira 2014. Section 4.3.
#pragma once

#include <vector>

#include "encoder/base/result.h"
#include "encoder/image/geometry_image.h"
#include "encoder/surface/surface_point.h"
#include "encoder/tiles/locate_samples.h"
#include "encoder/tiles/tile_image.h"
#include "encoder/tiles/tile_map.h"

namespace gim {

// In: the positions of the mesh, and a point of map.triangles for each sample (locate_samples()). O(samples).
TileImage sample_tiles(const std::vector<Vec3>& positions, const TileMap& map, const std::vector<SurfacePoint>& points,
                       uint32_t exponent);

// The atlas of tiles. Copies of a sample are one surface point, with equal bits. Slots without a tile, and cells between
// slots, are empty. O(texels).
Result<GeometryImage> atlas_of(const TileImage& tiles);
// Per texel of the atlas: the number of its sample, or kNone.
Result<std::vector<uint32_t>> samples_of_atlas(const TileImage& tiles);

}  // namespace gim

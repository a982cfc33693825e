// The transpose of the inverse wavelet on tiles (format/tile_lifting.h), seen as a linear map.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/tiles/tile_pyramid.h"
#include "format/quad_complex.h"

namespace gim {

// The transpose of restore_tiles, seen as a map to grids with repeated borders. grids: per tile (2^exponent + 1)^2
// triples. Details on edges are in the tile of the lower half-edge; those of the other tile are 0. Cost: O(samples).
template <class Wavelet>
TilePyramid<float> restore_tiles_transposed(const QuadComplex& complex, std::vector<float> grids, uint32_t exponent);

}  // namespace gim

// Codes a quantized image on a complex of tiles to one stream for each level.  spec/gim-format.md, "Tiles".
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/tiles/tile_pyramid.h"
#include "format/trained_models.h"

namespace gim {

// Returns the streams, coarsest first. The first one holds the base and all coarser steps. level_count: 1 .. steps of the
// pyramid. The pyramid keeps its values, but details on edges become right in both tiles.
std::vector<std::vector<uint8_t>> code_tiles(const QuadComplex& complex, TilePyramid<int32_t>& pyramid,
                                             uint32_t level_count, CoefficientKind kind);

}  // namespace gim

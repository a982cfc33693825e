// Finds the rails of the samples of tiles: the creases that lie on borders of tiles.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/image/rails.h"
#include "encoder/surface/surface_point.h"
#include "encoder/tiles/tile_map.h"
#include "format/quad_complex.h"

namespace gim {

struct CreaseRails {
    Rails rails;                  // of the samples, numbered as TileSamples numbers them
    std::vector<bool> half_edge;  // per half-edge of the complex: its edge lies on a crease, with all of its samples
};

// In:  the mesh; per half-edge 3f+i whether it lies on a crease (empty: none do; one half-edge of two is enough); its
//      tiles, and the place of each of their samples.
// Out: a rail is a crease from corner to corner. Corners are ends of creases, places where several meet, and places on a
//      boundary; samples there do not move. An edge whose samples do not all lie on one crease has no rail.
// Cost: O(F log F + samples).
CreaseRails crease_rails(const Mesh& dense, const std::vector<bool>& sharp, const TileMap& map,
                         const std::vector<SurfacePoint>& points, const QuadComplex& complex, uint32_t side);

}  // namespace gim

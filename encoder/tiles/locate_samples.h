// Finds the place on the surface of every sample of the tiles.
// Maximo, Velho, Siqueira 2014. Section 4.3: "ordinary scan conversion" of the triangles inside a chart. We differ: the
// triangles across borders are converted as well, so a sample on a border needs no average.
#pragma once

#include <vector>

#include "encoder/base/result.h"
#include "encoder/surface/surface_point.h"
#include "encoder/tiles/tile_map.h"

namespace gim {

// Returns a point of map.triangles for each sample, numbered as TileSamples does, at `side` intervals along each edge.
// Samples at the corners of tiles are vertices. Those on creases and boundaries lie on edges. O(F + samples).
Result<std::vector<SurfacePoint>> locate_samples(const TileMap& map, uint32_t side);

// The quads with their vertices numbered by first appearance, as complexes number them.
struct NumberedQuads {
    std::vector<Quad> quads;
    std::vector<uint32_t> vertices;  // per number: the vertex
};
NumberedQuads number_quads(const std::vector<Quad>& quads);

}  // namespace gim

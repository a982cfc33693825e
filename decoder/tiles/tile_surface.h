// Vertices, triangles and normals of a decoded complex of tiles.  spec/gim-format.md, "Tiles".
// Cells are split along the shorter diagonal, those at the corners of a tile through the corner. So no two triangles
// share both ends of an edge, however tiles are glued.
#pragma once

#include <cstdint>

#include "format/quad_complex.h"
#include "format/tile_atlas.h"
#include "format/tile_planes.h"

namespace gim {

// One level. samples: per tile (side+1)^2 triples.
struct TileSurface {
    const QuadComplex& complex;
    uint32_t side;  // intervals along a side of a tile
    const float* samples;

    size_t tile_size() const { return size_t{side + 1} * (side + 1); }
    TileSamples numbers() const { return {complex, side}; }
};

// Work space of triangulate_tiles.
struct TriangulateTilesWork {
    float* rows = nullptr;        // 6 * (side + 1)
    uint32_t* is_main = nullptr;  // side
    uint32_t* numbers = nullptr;  // 2 * (side + 1)
};

// Calls f(vertex, tile, sample of the tile, count, stride) for all vertices, in runs of samples of one tile. Each vertex
// comes once, with its first sample along its edge or in its lowest tile.
template <class F>
void for_each_run(const TileSurface& surface, const F& f) {
    const QuadComplex& complex = surface.complex;
    const TilePlanes grid(surface.side);
    const auto run = [&](uint32_t vertex, uint32_t half_edge, uint32_t t, uint32_t count) {
        const Run& low = grid.sides[side_of(half_edge)].low;
        f(vertex, tile_of(half_edge), static_cast<uint32_t>(low.at(t) / 3), count,
          static_cast<int32_t>(low.stride / 3));
    };
    uint32_t next = 0;
    for (uint32_t h = 0; h < complex.half_edges(); ++h) {
        if (complex.vertex[h] == next) run(next++, h, 0, 1);
    }
    for (uint32_t e = 0; e < complex.edges; ++e, next += surface.side - 1)
        run(next, complex.lower[e], 1, surface.side - 1);
    for (uint32_t t = 0; t < complex.tiles; ++t) {
        for (uint32_t row = 1; row < surface.side; ++row, next += surface.side - 1)
            f(next, t, row * (surface.side + 1) + 1, surface.side - 1, 1);
    }
}

// The numbers of a tile's samples: vertices of the mesh, or samples of the atlas.
struct MeshNumbers {
    TileSamples samples;
    uint32_t side;
    // Sets the numbers of a row, of side + 1 samples.
    void load(uint32_t tile, uint32_t row, uint32_t* numbers) const {
        numbers[0] = samples.at(tile, row, 0);
        numbers[side] = samples.at(tile, row, side);
        if (row > 0 && row < side) {
            const uint32_t first = samples.inner(tile) + (row - 1) * (side - 1);
            for (uint32_t c = 1; c < side; ++c) numbers[c] = first + c - 1;
        } else {
            for (uint32_t c = 1; c < side; ++c) numbers[c] = samples.at(tile, row, c);
        }
    }
};
struct GridNumbers {
    TileAtlas atlas;
    uint32_t side;
    void load(uint32_t tile, uint32_t row, uint32_t* numbers) const {
        const uint32_t first = (atlas.row(tile) + row) * atlas.width() + atlas.column(tile);
        for (uint32_t c = 0; c <= side; ++c) numbers[c] = first + c;
    }
};

// Any of these, or HardVertices, whose load() is behind a pointer. It refers to them.
class TileNumbers {
  public:
    template <class Numbers>
    explicit TileNumbers(const Numbers& numbers)
        : numbers_(&numbers), load_([](const void* of, uint32_t tile, uint32_t row, uint32_t* out) {
              static_cast<const Numbers*>(of)->load(tile, row, out);
          }) {}
    void load(uint32_t tile, uint32_t row, uint32_t* numbers) const { load_(numbers_, tile, row, numbers); }

  private:
    const void* numbers_;
    void (*load_)(const void* of, uint32_t tile, uint32_t row, uint32_t* out);
};

// Writes 2 * tiles * side^2 triangles, tile by tile, cell by cell.
void triangulate_tiles(const TileSurface& surface, const TriangulateTilesWork& work, const TileNumbers& numbers,
                       uint32_t* triangles);

// Sets the unit normals of `count` vertices: the cross products of differences within each tile, central ones or
// one-sided at its border, summed over the tiles; zero if the sum is. row: side + 1 numbers, work space.
void tile_normals(const TileSurface& surface, const TileNumbers& numbers, uint32_t count, uint32_t* row,
                  float* normals);

}  // namespace gim

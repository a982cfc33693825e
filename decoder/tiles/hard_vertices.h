// Vertices of a complex of tiles that is split along its sharp edges, so that each side has normals of its own.
// spec/gim-format.md, "Tiles".
#pragma once

#include <cstdint>

#include "decoder/tiles/tile_surface.h"

namespace gim {

inline constexpr uint32_t kNoCopies = UINT32_MAX;

// The first vertices are those of the mesh without splits. Copies follow: of corners, then of the samples on edges.
struct HardVertices {
    const QuadComplex& complex;
    TileSamples shared;
    uint32_t side;
    uint32_t* corner;  // per half-edge: the vertex at its start, in its tile
    uint32_t* copies;  // per edge: the vertex at place 1 of its upper half-edge, others follow; or kNoCopies
    uint32_t count = 0;

    // The vertex at place t = 0 .. side of a half-edge, in its tile.
    uint32_t along(uint32_t half_edge, uint32_t t) const {
        if (t == 0) return corner[half_edge];
        if (t == side) return corner[next_side(half_edge)];
        const uint32_t e = complex.edge[half_edge];
        const bool has_copy = copies[e] != kNoCopies && complex.lower[e] != half_edge;
        return has_copy ? copies[e] + t - 1 : shared.along(half_edge, t);
    }
    // Sets the numbers of a row, of side + 1 samples.
    void load(uint32_t tile, uint32_t row, uint32_t* numbers) const;
};

// is_sharp: per edge, 1 or 0. corner, copies: 4 * complex.tiles numbers each, which become those of the result. There are
// at most as many vertices as all tiles have samples, counting each tile for itself. O(tiles).
HardVertices split_sharp_edges(const TileSurface& surface, const uint32_t* is_sharp, uint32_t* corner,
                               uint32_t* copies);

// Calls f(vertex, tile, sample of the tile) for all copies. Some come more than once.
template <class F>
void for_each_copy(const HardVertices& hard, const F& f) {
    const uint32_t first_copy = hard.shared.count();
    const TilePlanes grid(hard.side);
    for (uint32_t h = 0; h < hard.complex.half_edges(); ++h) {
        const Run& low = grid.sides[side_of(h)].low;
        for (uint32_t t = 0; t < hard.side; ++t) {
            const uint32_t vertex = hard.along(h, t);
            if (vertex >= first_copy) f(vertex, tile_of(h), static_cast<uint32_t>(low.at(t) / 3));
        }
    }
}

}  // namespace gim

// The topology of a base mesh of quads: which sides of which tiles are one edge, which corners are one vertex. Components,
// boundaries and handles of any number. spec/gim-format.md, "Tiles".
//
// Half-edge 4q + i runs from corner i of tile q to corner i + 1, counter-clockwise seen from outside. Its mate runs back
// along the same edge in the tile on the other side. Edges are numbered by their lower half-edge, in ascending order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "format/mate.h"

namespace gim {

inline constexpr uint32_t kMostTiles = uint32_t{1} << 20;

using Quad = std::array<uint32_t, 4>;  // the vertices at the corners

constexpr uint32_t tile_of(uint32_t half_edge) { return half_edge / 4; }
constexpr uint32_t side_of(uint32_t half_edge) { return half_edge % 4; }
// The next and the previous side of the same tile.
constexpr uint32_t next_side(uint32_t half_edge) { return (half_edge & ~3u) | ((half_edge + 1) & 3u); }
constexpr uint32_t previous_side(uint32_t half_edge) { return (half_edge & ~3u) | ((half_edge + 3) & 3u); }

// The arrays are the caller's.
struct QuadComplex {
    uint32_t tiles = 0, vertices = 0, edges = 0;
    // Per half-edge: its mate, or kNoMate on a boundary; the vertex where it starts; its edge.
    uint32_t *mate = nullptr, *vertex = nullptr, *edge = nullptr;
    // Per edge: its lower half-edge.
    uint32_t* lower = nullptr;
    // Per vertex: the number of its tiles, and whether it lies on a boundary.
    uint32_t* valence = nullptr;
    uint8_t* on_boundary = nullptr;

    uint32_t half_edges() const { return 4 * tiles; }
};

// What is wrong with a list of quads.
struct QuadFault {
    enum class Kind {
        kFine,
        kNoVertex,       // a corner names a vertex that there is not
        kRepeated,       // two corners of a tile are one vertex
        kCrowdedEdge,    // two half-edges run along an edge in the same direction
        kUnusedVertex,   // no tile has the vertex
        kTouchingTiles,  // the tiles at a vertex are not one fan
    };
    Kind kind = Kind::kFine;
    uint32_t at = 0;  // kNoVertex, kRepeated: the tile; kCrowdedEdge: the half-edge; else the vertex
};

// Sets complex->mate from quads, whose vertices are 0 .. vertices - 1. work: 4 * quads + vertices + 1 numbers.
// Cost: O(n log n).
QuadFault find_mates(std::span<const Quad> quads, uint32_t vertices, std::span<uint32_t> work, uint32_t* mate);

// Numbers vertices and edges from complex->mate and complex->tiles. Vertices are numbered by first appearance, tile by
// tile, corner by corner. There are at most 4 vertices and 4 edges for each tile. Returns false if two corners of a tile
// are one vertex. Any mates that are mutual and not themselves make vertices whose tiles are one fan. Cost: O(tiles).
bool number_complex(QuadComplex* complex);

// Numbers of the samples at `side` intervals along each edge: vertices; then the inner samples of the edges, from the
// start of the lower half-edge to its end; then the inner samples of the tiles, row by row. Corner 0 of a tile is at
// (row 0, column 0), corner 1 at (0, side), corner 2 at (side, side), corner 3 at (side, 0).
class TileSamples {
  public:
    TileSamples(const QuadComplex& complex, uint32_t side) : complex_(complex), side_(side) {}

    uint32_t count() const { return inner(complex_.tiles); }
    // The first inner sample of an edge, of a tile.
    uint32_t on_edge(uint32_t edge) const { return complex_.vertices + edge * (side_ - 1); }
    uint32_t inner(uint32_t tile) const {
        return complex_.vertices + complex_.edges * (side_ - 1) + tile * (side_ - 1) * (side_ - 1);
    }
    // The sample at place t = 0 .. side of a half-edge.
    uint32_t along(uint32_t half_edge, uint32_t t) const {
        if (t == 0) return complex_.vertex[half_edge];
        if (t == side_) return complex_.vertex[next_side(half_edge)];
        const uint32_t e = complex_.edge[half_edge];
        return on_edge(e) + (complex_.lower[e] == half_edge ? t : side_ - t) - 1;
    }
    uint32_t at(uint32_t tile, uint32_t row, uint32_t column) const {
        if (row == 0) return along(4 * tile, column);
        if (column == side_) return along(4 * tile + 1, row);
        if (row == side_) return along(4 * tile + 2, side_ - column);
        if (column == 0) return along(4 * tile + 3, side_ - row);
        return inner(tile) + (row - 1) * (side_ - 1) + column - 1;
    }

  private:
    const QuadComplex& complex_;
    uint32_t side_;
};

}  // namespace gim

// The tiles of an image as a mesh of quads: how many they are, how they are glued, how their samples are numbered.
#pragma once

#include <cstdint>

#include "format/mate.h"
#include "format/quad_complex.h"

namespace gim {

struct DomainShape {
    uint32_t tiles = 0, intervals = 0, vertices = 0;
    // Where tiles lie in the image: `columns` of them in a row, each `slot` samples from the one before. Tiles that share the
    // samples of their sides, the cells of a square, are as far apart as they have intervals.
    uint32_t columns = 1, slot = 0;

    // How often a base triangle can be split in two, one after the other. intervals is a power of 2.
    uint32_t most_splits() const {
        uint32_t k = 0;
        while ((intervals >> k) > 1) ++k;
        return 2 * k;
    }
    uint32_t rows() const { return (tiles + columns - 1) / columns; }
    uint32_t width() const { return columns * slot + (slot == intervals ? 1 : 0); }
    uint32_t height() const { return rows() * slot + (slot == intervals ? 1 : 0); }
    // The first sample of a tile.
    uint32_t row_of(uint32_t tile) const { return tile / columns * slot; }
    uint32_t column_of(uint32_t tile) const { return tile % columns * slot; }
    uint64_t most_triangles() const { return 2 * uint64_t{tiles} * intervals * intervals; }
};

// How tiles are glued and numbered. Arrays of the caller.
struct TileGlue {
    // Per half-edge (format/quad_complex.h): its mate or kNoMate; the vertex where it starts; its inner samples: the first
    // one, and what is added from one to the next.
    uint32_t *mate = nullptr, *corner = nullptr, *along = nullptr;
    int32_t* step = nullptr;
    // Per tile: the inner sample of row 1 and column 1. Columns follow each other.
    uint32_t* inner = nullptr;
    uint32_t row_step = 0;  // from an inner sample to the one in the next row
    // Per tile: 1 if the base is split from corner 1 to corner 3, 0 if from corner 0 to corner 2.
    uint8_t* is_anti = nullptr;
};

}  // namespace gim

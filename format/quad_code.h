// Codes which sides of which tiles are one edge. Encoder and decoder share this traversal, each with its own coder.
// spec/gim-format.md, "Tiles".
//
// A region grows tile by tile. Its border is a set of loops of half-edges without a mate. The half-edges take their turn
// in the order of their numbers. Each is joined with its neighbour in the loop, or gets a new tile, or is a boundary of the
// surface, or is joined with a half-edge anywhere else. The number of tiles that are around a vertex so far tells most of
// the time whether the two half-edges there are one edge. Whatever bits come, mates are mutual.
// After: Touma, Gotsman. Triangle Mesh Compression. 1998; King, Rossignac, Szymczak. Connectivity Compression for
// Irregular Quadrilateral Meshes. 1999. We join edges, not vertices, so that handles and boundaries need no case of theirs.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "format/bit_model.h"
#include "format/quad_complex.h"

namespace gim {

// Work space, of the caller. Per half-edge: its neighbours in its loop of the border, and how many tiles are around its
// start between the neighbour before and itself.
struct QuadCodeWork {
    uint32_t *next = nullptr, *previous = nullptr, *fan = nullptr;
};

struct QuadModels {
    static constexpr uint32_t kMostFan = 7;

    QuadModels();
    // Whether two neighbours are one edge: by tiles around the vertex between them, by whether all tiles are there.
    std::array<std::array<BitModel, kMostFan + 1>, 2> joined;
    std::array<BitModel, 2> other;  // no new tile: by whether a boundary is next to the half-edge
    BitModel boundary;              // then: whether it is a boundary
};

inline QuadModels::QuadModels() {
    constexpr uint16_t open[kMostFan + 1] = {65000, 65200, 64000, 46000, 24000, 14000, 10000, 8000};
    for (uint32_t i = 0; i <= kMostFan; ++i) {
        joined[0][i] = BitModel(open[i], 12);
        joined[1][i] = BitModel(static_cast<uint16_t>(open[i] / 4), 2);
    }
    other = {BitModel(64000, 12), BitModel(48000, 4)};
    boundary = BitModel(48000, 2);
}

// Source knows the complex that is written; a reader ignores what it returns. Half-edges have the numbers of the code.
//   bool joins(h, other): whether h and another half-edge of the code are mates
//   bool is_boundary(h), uint32_t mate(h): of a half-edge whose mate is in the code
//   void start(tile): a tile that hangs on nothing; void cross(tile, h): a tile whose side 0 is the mate of h
// complex->tiles must be set. Fills complex->mate. Returns false if the bits say what no writer writes.
template <class Coder, class Source>
bool code_quads(Coder& coder, QuadModels& models, Source& source, const QuadCodeWork& work, QuadComplex* complex) {
    constexpr uint32_t kOpen = UINT32_MAX - 1;  // in place of a mate: none yet
    static_assert(kNoMate != kOpen);
    uint32_t *next = work.next, *previous = work.previous, *fan = work.fan;
    uint32_t* mate = complex->mate;
    const uint32_t end = complex->half_edges();
    uint32_t made = 0;  // half-edges of the tiles so far

    const auto link = [&](uint32_t a, uint32_t b) {
        next[a] = b;
        previous[b] = a;
    };
    // Makes two half-edges one edge and takes them out of their loops.
    const auto join = [&](uint32_t a, uint32_t b) {
        mate[a] = b;
        mate[b] = a;
        const uint32_t before_a = previous[a], after_a = next[a], before_b = previous[b], after_b = next[b];
        fan[after_b] += fan[a];
        fan[after_a] += fan[b];
        link(before_a, after_b);
        link(before_b, after_a);
    };
    const auto add_tile = [&] {
        for (uint32_t i = 0; i < 4; ++i) {
            mate[made + i] = kOpen;
            fan[made + i] = 1;
            link(made + i, made + (i + 1) % 4);
        }
        made += 4;
    };
    const auto joined = [&](uint32_t h, uint32_t other, uint32_t corner) {
        if (mate[other] != kOpen) return false;
        BitModel& model = models.joined[made == end][std::min(fan[corner], QuadModels::kMostFan)];
        uint32_t bit = 0;
        if constexpr (Coder::kWrites) bit = source.joins(h, other);
        if (!coder.code_bit(model, bit)) return false;
        join(h, other);
        return true;
    };

    for (uint32_t h = 0; h < end; ++h) {
        if (h == made) {
            if constexpr (Coder::kWrites) source.start(tile_of(made));
            add_tile();
        }
        if (mate[h] != kOpen) continue;
        const uint32_t after = next[h], before = previous[h];
        if (after == h) return false;  // the edge joins a vertex with itself
        if (joined(h, after, after)) continue;
        if (before != after && joined(h, before, h)) continue;
        uint32_t bit = 1;
        if (made < end) {
            const bool beside_boundary = mate[after] == kNoMate || mate[before] == kNoMate;
            if constexpr (Coder::kWrites) bit = source.is_boundary(h) || source.mate(h) < made;
            bit = coder.code_bit(models.other[beside_boundary], bit);
        }
        if (!bit) {
            if constexpr (Coder::kWrites) source.cross(tile_of(made), h);
            const uint32_t tile = made;
            add_tile();
            join(h, tile);
            continue;
        }
        bit = 1;
        const uint32_t beyond = made - 1 - h;  // half-edges after this one
        if (beyond > 0) {
            if constexpr (Coder::kWrites) bit = source.is_boundary(h);
            bit = coder.code_bit(models.boundary, bit);
        }
        if (bit) {
            mate[h] = kNoMate;
            continue;
        }
        uint32_t far = 0;
        if constexpr (Coder::kWrites) far = source.mate(h) - h - 1;
        far = coder.code_raw(far, static_cast<uint32_t>(std::bit_width(beyond - 1)));
        if (far >= beyond) return false;
        far += h + 1;
        if (mate[far] != kOpen || next[far] == far) return false;
        join(h, far);
    }
    return true;
}

}  // namespace gim

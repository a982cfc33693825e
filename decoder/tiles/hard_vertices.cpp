#include "decoder/tiles/hard_vertices.h"

#include <algorithm>

namespace gim {
namespace {

constexpr uint32_t kUnset = UINT32_MAX;

// Gives the corners around the start of a half-edge one number, as far as no sharp edge or boundary is between them.
void number_fan(const QuadComplex& complex, const uint32_t* is_sharp, uint32_t half_edge, uint32_t number,
                uint32_t* corner) {
    const auto can_cross = [&](uint32_t h) { return complex.mate[h] != kNoMate && !is_sharp[complex.edge[h]]; };
    uint32_t h = half_edge;
    corner[h] = number;
    while (can_cross(previous_side(h))) {
        h = complex.mate[previous_side(h)];
        if (corner[h] != kUnset) return;  // all around
        corner[h] = number;
    }
    h = half_edge;
    while (can_cross(h)) {
        h = next_side(complex.mate[h]);
        if (corner[h] != kUnset) return;
        corner[h] = number;
    }
}

}  // namespace

void HardVertices::load(uint32_t tile, uint32_t row, uint32_t* numbers) const {
    const uint32_t first = 4 * tile;
    if (row == 0) {
        for (uint32_t c = 0; c <= side; ++c) numbers[c] = along(first, c);
    } else if (row == side) {
        for (uint32_t c = 0; c <= side; ++c) numbers[c] = along(first + 2, side - c);
    } else {
        MeshNumbers{shared, side}.load(tile, row, numbers);
        numbers[0] = along(first + 3, side - row);
        numbers[side] = along(first + 1, row);
    }
}

HardVertices split_sharp_edges(const TileSurface& surface, const uint32_t* is_sharp, uint32_t* corner,
                               uint32_t* copies) {
    const QuadComplex& complex = surface.complex;
    HardVertices hard{complex, surface.numbers(), surface.side, corner, copies, surface.numbers().count()};
    std::fill_n(corner, complex.half_edges(), kUnset);
    uint32_t seen = 0;
    for (uint32_t h = 0; h < complex.half_edges(); ++h) {
        if (corner[h] != kUnset) continue;
        const bool is_new = complex.vertex[h] == seen;  // vertices are numbered by first appearance
        number_fan(complex, is_sharp, h, is_new ? seen : hard.count, corner);
        ++(is_new ? seen : hard.count);
    }
    for (uint32_t e = 0; e < complex.edges; ++e) {
        const bool is_split = is_sharp[e] && complex.mate[complex.lower[e]] != kNoMate;
        copies[e] = is_split ? hard.count : kNoCopies;
        if (is_split) hard.count += hard.side - 1;
    }
    return hard;
}

}  // namespace gim

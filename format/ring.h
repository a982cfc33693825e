// The ring of a square image: its 4*(side-1) boundary samples in the order that format/sideband.h defines.
//
// With rows down and columns to the right, the ring runs counter-clockwise seen from outside the surface:
// (d position / d column) x (d position / d row) points outwards.
#pragma once

#include <cstdint>

namespace gim {

struct GridPoint {
    uint32_t row = 0, column = 0;

    friend bool operator==(const GridPoint&, const GridPoint&) = default;
};

constexpr uint32_t ring_length(uint32_t side) { return 4 * (side - 1); }

// k in 0 .. ring_length(side)-1.
constexpr GridPoint ring_point(uint32_t side, uint32_t k) {
    const uint32_t last = side - 1;
    if (k < last) return {0, k};
    if (k < 2 * last) return {k - last, last};
    if (k < 3 * last) return {last, 3 * last - k};
    return {4 * last - k, 0};
}

constexpr bool on_rim(uint32_t side, uint32_t row, uint32_t column) {
    return row == 0 || column == 0 || row == side - 1 || column == side - 1;
}

// Only for samples on the rim.
constexpr uint32_t ring_index(uint32_t side, uint32_t row, uint32_t column) {
    const uint32_t last = side - 1;
    if (row == 0) return column;
    if (column == last) return last + row;
    if (row == last) return 3 * last - column;
    return 4 * last - row;
}

}  // namespace gim

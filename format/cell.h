// A point between the samples of a grid: its cell, and the weights of the corners of the triangle that holds it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace gim {

struct CellPoint {
    uint32_t cell = 0;                  // row-major
    double x = 0, y = 0;                // inside the cell, 0..1, along columns and rows
    std::array<uint32_t, 4> corners{};  // samples: at (row, column), in the next column, in the next row, in both

    // The weights of linear interpolation over two triangles. main_diagonal splits the cell from first to last corner.
    std::array<double, 4> weights(bool main_diagonal) const {
        if (main_diagonal) {
            if (x >= y) return {1 - x, x - y, 0, y};
            return {1 - y, 0, y - x, x};
        }
        if (x + y <= 1) return {1 - x - y, x, y, 0};
        return {0, 1 - y, 1 - x, x + y - 1};
    }
};

// row, column: in 0 .. side-1.
inline CellPoint locate_in_cell(uint32_t side, double row, double column) {
    const uint32_t cells = side - 1;
    const uint32_t r = std::min(static_cast<uint32_t>(row), cells - 1);
    const uint32_t c = std::min(static_cast<uint32_t>(column), cells - 1);
    const uint32_t first = r * side + c;
    return {r * cells + c, column - c, row - r, {first, first + 1, first + side, first + side + 1}};
}

}  // namespace gim

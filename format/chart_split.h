// The rule for the diagonals of a chart's cells. It takes the shorter one, but a fixed one if a diagonal could double
// an edge: whether the glued surface is a manifold must not depend on positions.  spec/gim-format.md, "Charts".
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 3 always takes the shorter one.
#pragma once

#include <cstdint>

#include "format/split.h"

namespace gim {

// Grid has on_border(row, column) and point(row, column) for defined samples. Points are equal if samples are glued.

// Returns whether the diagonal from border sample (row, column) to an inner sample may double another edge. It may if
// another of the inner sample's neighbours is the same surface point.
template <class Grid>
bool chart_diagonal_may_double(const Grid& grid, uint32_t row, uint32_t column, uint32_t inner_row,
                               uint32_t inner_column) {
    for (uint32_t r = inner_row - 1; r <= inner_row + 1; ++r) {
        for (uint32_t c = inner_column - 1; c <= inner_column + 1; ++c) {
            if ((r == row && c == column) || !grid.on_border(r, c)) continue;
            if (grid.point(r, c) == grid.point(row, column)) return true;
        }
    }
    return false;
}

// The split of a cell with four defined samples. An inner sample has eight defined neighbours.
template <class Grid>
Split chart_split(const Grid& grid, uint32_t row, uint32_t column) {
    const auto joins_border = [&](uint32_t c0, uint32_t c1) {
        return grid.on_border(row, c0) && grid.on_border(row + 1, c1);
    };
    const auto may_double = [&](uint32_t c0, uint32_t c1) {
        if (grid.on_border(row, c0)) return chart_diagonal_may_double(grid, row, c0, row + 1, c1);
        return grid.on_border(row + 1, c1) && chart_diagonal_may_double(grid, row + 1, c1, row, c0);
    };
    const bool main_joins = joins_border(column, column + 1), anti_joins = joins_border(column + 1, column);
    if (main_joins || anti_joins) return main_joins && !anti_joins ? Split::kAnti : Split::kMain;
    const bool main_doubles = may_double(column, column + 1), anti_doubles = may_double(column + 1, column);
    if (main_doubles) return anti_doubles ? Split::kMain : Split::kAnti;
    return anti_doubles ? Split::kMain : Split::kShorter;
}

}  // namespace gim

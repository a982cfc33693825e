// A rasterized chart in one orientation, as the packing's stages see it.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/charts/chart_mask.h"

namespace gim {

// A horizontal run of samples.
struct PieceRun {
    uint32_t row, column, length;
};

struct Piece {
    uint32_t width = 0, height = 0;
    double centre = 0;             // mean row of its samples
    std::vector<PieceRun> runs;    // its samples, row by row
    std::vector<PieceRun> scan;    // the same, longest first, because long runs rule out positions soonest
    std::vector<PieceRun> reach;   // samples that other charts must not use: its own and their neighbours in row and
                                   // column; rows and columns count from one before its first
    uint32_t cell = 1;             // side of a coarse cell in samples
    std::vector<PieceRun> coarse;  // the coarse cells of which it covers half
    ChartMask chart;
};

using Shape = std::vector<Piece>;  // one piece per usable orientation

struct PieceSpot {
    uint32_t orientation = 0, column = 0, row = 0;
};

// A rectangle with one spot per shape.
struct PieceLayout {
    uint32_t width = 0, height = 0;
    std::vector<PieceSpot> spots;
    uint64_t area() const { return uint64_t{width} * height; }
};

Piece make_piece(ChartMask chart, uint32_t cell);

}  // namespace gim

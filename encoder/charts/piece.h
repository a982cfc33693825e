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
    std::vector<PieceRun> scan;    // the same, longest first: the long ones rule positions out soonest
    std::vector<PieceRun> reach;   // what it takes from other charts: itself and its neighbours in row and column, in
                                   // rows and columns counted from one before its own first
    uint32_t cell = 1;             // side of a coarse cell in samples
    std::vector<PieceRun> coarse;  // the cells of which it covers half
    ChartMask chart;
};

using Shape = std::vector<Piece>;  // one piece per usable orientation

struct PieceSpot {
    uint32_t orientation = 0, column = 0, row = 0;
};

// One spot per shape.
struct PieceLayout {
    uint32_t width = 0, height = 0;
    std::vector<PieceSpot> spots;
    uint64_t area() const { return uint64_t{width} * height; }
};

Piece make_piece(ChartMask chart, uint32_t cell);

}  // namespace gim

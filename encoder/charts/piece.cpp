#include "encoder/charts/piece.h"

#include <algorithm>
#include <utility>

namespace gim {

namespace {

std::vector<PieceRun> runs_of(const SampleMask& mask) {
    std::vector<PieceRun> runs;
    for (uint32_t row = 0; row < mask.height; ++row) {
        for (uint32_t column = 0; column < mask.width; ++column) {
            if (!mask.at(column, row)) continue;
            const uint32_t first = column;
            while (mask.at(column, row)) ++column;
            runs.push_back({row, first, column - first});
        }
    }
    return runs;
}

// Returns the mask with its neighbours in row and column added, and a ring of room for them.
SampleMask grown(const SampleMask& mask) {
    SampleMask result{mask.width + 2, mask.height + 2, {}};
    result.defined.resize(size_t{result.width} * result.height);
    for (uint32_t row = 0; row < result.height; ++row) {
        for (uint32_t column = 0; column < result.width; ++column) {
            const int64_t x = int64_t{column} - 1, y = int64_t{row} - 1;
            result.defined[size_t{row} * result.width + column] =
                mask.at(x, y) || mask.at(x - 1, y) || mask.at(x + 1, y) || mask.at(x, y - 1) || mask.at(x, y + 1);
        }
    }
    return result;
}

// Returns the cells of which at least half is covered, or else the one that is covered most.
SampleMask shrunk(const SampleMask& mask, uint32_t cell) {
    SampleMask result{(mask.width + cell - 1) / cell, (mask.height + cell - 1) / cell, {}};
    std::vector<uint32_t> covered(size_t{result.width} * result.height, 0);
    for (uint32_t row = 0; row < mask.height; ++row) {
        for (uint32_t column = 0; column < mask.width; ++column)
            covered[size_t{row / cell} * result.width + column / cell] += mask.at(column, row);
    }
    const uint32_t enough = std::min((cell * cell + 1) / 2, *std::max_element(covered.begin(), covered.end()));
    for (const uint32_t count : covered) result.defined.push_back(count >= enough);
    return result;
}

}  // namespace

Piece make_piece(ChartMask chart, uint32_t cell) {
    Piece piece;
    piece.width = chart.mask.width;
    piece.height = chart.mask.height;
    piece.runs = runs_of(chart.mask);
    for (const PieceRun& run : piece.runs) piece.centre += static_cast<double>(run.row) * run.length / chart.defined;
    piece.scan = piece.runs;
    std::stable_sort(piece.scan.begin(), piece.scan.end(),
                     [](const PieceRun& a, const PieceRun& b) { return a.length > b.length; });
    piece.reach = runs_of(grown(chart.mask));
    piece.cell = cell;
    piece.coarse = runs_of(shrunk(chart.mask, piece.cell));
    piece.chart = std::move(chart);
    return piece;
}

}  // namespace gim

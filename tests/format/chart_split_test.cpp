#include "format/chart_split.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace gim {
namespace {

// A chart of 6 x 6 samples with its rim as border; pairs of samples (row, column) that are one surface point.
struct Square {
    static constexpr uint32_t kSide = 6;
    using Place = std::pair<uint32_t, uint32_t>;
    std::vector<std::pair<Place, Place>> glued;

    bool on_border(uint32_t row, uint32_t column) const {
        return row == 0 || column == 0 || row + 1 == kSide || column + 1 == kSide;
    }
    uint32_t point(uint32_t row, uint32_t column) const {
        for (const auto& [a, b] : glued) {
            if (b == Place(row, column)) return point(a.first, a.second);
        }
        return row * kSide + column;
    }
};

// The cell at (0, 2): two border samples above two inner ones. An inner sample that leads to a surface point twice, once
// by the diagonal, would make two edges one.
TEST(ChartSplit, ADiagonalThatWouldDoubleAnEdgeIsNotTaken) {
    EXPECT_EQ(chart_split(Square{}, 0, 2), Split::kShorter);
    EXPECT_EQ(chart_split(Square{{{{0, 2}, {0, 4}}}}, 0, 2), Split::kAnti);  // (1, 3) leads to (0, 4) and (0, 2)
    EXPECT_EQ(chart_split(Square{{{{0, 1}, {0, 3}}}}, 0, 2), Split::kMain);  // (1, 2) leads to (0, 1) and (0, 3)
}

TEST(ChartSplit, NoDiagonalJoinsTwoSamplesOfTheBorder) {
    EXPECT_EQ(chart_split(Square{}, 0, 0), Split::kMain);
    EXPECT_EQ(chart_split(Square{}, 4, 4), Split::kMain);
    EXPECT_EQ(chart_split(Square{}, 0, 4), Split::kAnti);
    EXPECT_EQ(chart_split(Square{}, 4, 0), Split::kAnti);
}

TEST(ChartSplit, InsideTheShorterOneIsTaken) {
    for (uint32_t row = 1; row < 4; ++row) {
        for (uint32_t column = 1; column < 4; ++column) EXPECT_EQ(chart_split(Square{}, row, column), Split::kShorter);
    }
}

}  // namespace
}  // namespace gim

#include "format/cell.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace gim {
namespace {

// The weights of a point reproduce the point. They are those of the triangle that it lies in.
TEST(CellPoint, WeightsGiveBackThePointInsideItsTriangle) {
    constexpr uint32_t kSide = 5;
    for (double row = 0; row <= kSide - 1; row += 0.23) {
        for (double column = 0; column <= kSide - 1; column += 0.31) {
            const CellPoint point = locate_in_cell(kSide, row, column);
            for (const bool main : {false, true}) {
                const std::array<double, 4> w = point.weights(main);
                double sum = 0, at_row = 0, at_column = 0;
                for (size_t i = 0; i < 4; ++i) {
                    EXPECT_GE(w[i], -1e-12);
                    sum += w[i];
                    at_row += w[i] * (point.corners[i] / kSide);
                    at_column += w[i] * (point.corners[i] % kSide);
                }
                EXPECT_NEAR(sum, 1, 1e-12);
                EXPECT_NEAR(at_row, row, 1e-12);
                EXPECT_NEAR(at_column, column, 1e-12);
                // One corner is outside the triangle: an end of the other diagonal.
                EXPECT_NEAR(main ? std::min(w[1], w[2]) : std::min(w[0], w[3]), 0, 1e-12);
            }
        }
    }
}

TEST(CellPoint, TheLastRowAndColumnBelongToTheLastCells) {
    const CellPoint corner = locate_in_cell(5, 4, 4);
    EXPECT_EQ(corner.cell, 15u);
    EXPECT_EQ(corner.corners[3], 24u);
    EXPECT_EQ(corner.weights(true)[3], 1);
    EXPECT_EQ(corner.weights(false)[3], 1);
}

}  // namespace
}  // namespace gim

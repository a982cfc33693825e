#include "encoder/surface/tutte.h"

#include <gtest/gtest.h>

namespace gim {
namespace {

TEST(Tutte, FreeVerticesLieAtTheMeanOfTheirNeighbours) {
    // Two free vertices, 4 and 5, inside a square.
    std::vector<Vec2> uv{{0, 0}, {3, 0}, {3, 3}, {0, 3}, {9, 9}, {9, 9}};
    const std::vector<uint8_t> fixed{1, 1, 1, 1, 0, 0};
    std::vector<std::array<uint32_t, 2>> arcs;
    const auto join = [&](uint32_t a, uint32_t b) { arcs.insert(arcs.end(), {{a, b}, {b, a}}); };
    join(4, 0), join(4, 3), join(4, 5), join(5, 1), join(5, 2), join(0, 1);
    ASSERT_TRUE(solve_tutte(arcs, fixed, uv));
    EXPECT_NEAR((uv[4] - (uv[0] + uv[3] + uv[5]) / 3).norm(), 0, 1e-12);
    EXPECT_NEAR((uv[5] - (uv[1] + uv[2] + uv[4]) / 3).norm(), 0, 1e-12);
    EXPECT_EQ(uv[2], Vec2(3, 3));
}

TEST(Tutte, NothingFreeIsNothingToDo) {
    std::vector<Vec2> uv{{0, 0}, {1, 0}, {0, 1}};
    EXPECT_TRUE(solve_tutte({{{0, 1}}}, {1, 1, 1}, uv));
    EXPECT_EQ(uv[1], Vec2(1, 0));
}

TEST(Tutte, FreeVertexWithoutAFixedOneIsRefused) {
    std::vector<Vec2> uv(2, Vec2::Zero());
    EXPECT_FALSE(solve_tutte({{{0, 1}, {1, 0}}}, {0, 0}, uv));
}

}  // namespace
}  // namespace gim

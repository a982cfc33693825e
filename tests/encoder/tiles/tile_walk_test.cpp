#include "encoder/tiles/tile_walk.h"

#include <gtest/gtest.h>

#include "encoder/tiles/code_complex.h"

namespace gim {
namespace {

// The six sides of a cube; every corner is a cone of three tiles.
TileWalker cube() {
    const std::vector<Quad> quads{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    const auto made = complex_of(quads, 8);
    const OwnComplex& complex = made.value();
    return TileWalker({complex.view().mate, complex.view().mate + complex.view().half_edges()});
}

TEST(TileWalk, GoesAroundTheCube) {
    const TileWalker walker = cube();
    for (const Vec2& way : {Vec2(4, 0), Vec2(-4, 0), Vec2(0, 4), Vec2(0, -4)}) {
        const Vec2 from(0.25, 0.625);
        const auto frame = walker.walk(2, from, from + way);
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->tile, 2u);
        EXPECT_EQ((*frame)(from + way), from);
    }
}

TEST(TileWalk, ComesBackTheSameWay) {
    const TileWalker walker = cube();
    const Vec2 from(0.125, 0.5), to(2.25, -1.75);
    const auto there = walker.walk(1, from, to);
    ASSERT_TRUE(there);
    const auto back = walker.walk(there->tile, (*there)(to), (*there)(from));
    ASSERT_TRUE(back);
    EXPECT_EQ(back->tile, 1u);
    EXPECT_EQ((*back)((*there)(from)), from);
}

TEST(TileWalk, RefusesAWayThroughACorner) {
    EXPECT_FALSE(cube().walk(0, {0.5, 0.5}, {1.5, 1.5}));
    EXPECT_TRUE(cube().walk(0, {0.5, 0.5}, {1.5, 1.499}));
    EXPECT_TRUE(cube().walk(0, {0.5, 0.5}, {1, 1}));
}

TEST(TileWalk, RefusesAWayOffTheSurface) {
    const auto made = complex_of({{0, 1, 2, 3}}, 4);
    const OwnComplex& complex = made.value();
    const TileWalker walker({complex.view().mate, complex.view().mate + 4});
    EXPECT_FALSE(walker.walk(0, {0.5, 0.5}, {1.5, 0.5}));
    EXPECT_TRUE(walker.walk(0, {0.5, 0.5}, {1, 0.5}));
}

}  // namespace
}  // namespace gim

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

TEST(TileWalk, TheFringeContinuesTheTilesBeyondBoundaries) {
    // Two tiles side by side: a boundary of six sides.
    const auto made = complex_of({{0, 1, 2, 3}, {1, 4, 5, 2}}, 6);
    const TileWalker walker = TileWalker::with_fringe(made.value().view());
    EXPECT_EQ(walker.complex_tiles(), 2u);
    const Vec2 from(0.75, 0.5), beyond(0.75, -0.25), beside(1.5, -0.25);
    const auto out = walker.walk(0, from, beyond);
    ASSERT_TRUE(out);
    EXPECT_GE(out->tile, 2u);
    const auto back = walker.walk(out->tile, (*out)(beyond), (*out)(from));
    ASSERT_TRUE(back);
    EXPECT_EQ(back->tile, 0u);
    EXPECT_EQ((*back)((*out)(from)), from);
    // Neighbours in the fringe are glued as the tiles that they continue.
    const auto along = walker.walk(out->tile, (*out)(beyond), (*out)(beside));
    const auto across = walker.walk(0, from, {1.5, 0.5});
    ASSERT_TRUE(along && across);
    const auto down = walker.walk(across->tile, (*across)(Vec2(1.5, 0.5)), (*across)(beside));
    ASSERT_TRUE(down);
    EXPECT_EQ(along->tile, down->tile);
    EXPECT_EQ((*along)((*out)(beside)), (*down)((*across)(beside)));
}

}  // namespace
}  // namespace gim

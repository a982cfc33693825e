// Groups of tiles, and the error of a cell, on domains made by hand.
#include "decoder/refine/tile_groups.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "decoder/refine/bounds.h"
#include "format/quad_complex.h"

namespace gim {
namespace {

// Rows x columns of tiles in a plane, one interval each, or each for itself.
struct Plane {
    uint32_t rows, columns;
    std::vector<uint32_t> mate, corner, along;
    std::vector<int32_t> step;
    std::vector<uint8_t> is_anti;
    std::vector<SampleValue> values;
    QuadDomain domain;

    Plane(uint32_t row_count, uint32_t column_count, bool are_glued) : rows(row_count), columns(column_count) {
        const uint32_t tiles = rows * columns, width = columns + 1;
        for (uint32_t t = 0; t < tiles; ++t) {
            const uint32_t r = t / columns, c = t % columns;
            for (const uint32_t v : {r * width + c, r * width + c + 1, (r + 1) * width + c + 1, (r + 1) * width + c})
                corner.push_back(v);
            const auto beyond = [&](bool is_there, uint32_t half_edge) {
                mate.push_back(are_glued && is_there ? half_edge : kNoMate);
            };
            beyond(r > 0, 4 * (t - columns) + 2);
            beyond(c + 1 < columns, 4 * (t + 1) + 3);
            beyond(r + 1 < rows, 4 * (t + columns));
            beyond(c > 0, 4 * (t - 1) + 1);
        }
        along.resize(4 * size_t{tiles});
        step.resize(4 * size_t{tiles});
        is_anti.resize(tiles);
        for (uint32_t v = 0; v < (rows + 1) * width; ++v)
            values.push_back({{static_cast<float>(v % width), static_cast<float>(v / width), 0}, 0, 0});
        TileGlue glue;
        glue.mate = mate.data();
        glue.corner = corner.data();
        glue.along = along.data();
        glue.step = step.data();
        glue.is_anti = is_anti.data();
        domain = QuadDomain({tiles, 1, (rows + 1) * width}, glue, values.data());
    }
};

struct Groups {
    std::vector<std::byte> memory;
    TileGroups groups;

    static TileGroups made(const Plane& plane, uint32_t connected, std::vector<std::byte>* memory) {
        Arena counter(nullptr);
        (void)TileGroups(&plane.domain, connected, &counter);
        memory->resize(counter.used());
        Arena arena(memory->data());
        return {&plane.domain, connected, &arena};
    }
    Groups(const Plane& plane, uint32_t connected) : groups(made(plane, connected, &memory)) { groups.run(); }
};

void expect_each_once(const TileGroups& groups, uint32_t tiles) {
    std::set<uint32_t> all;
    for (uint32_t i = 0; i < tiles; ++i) all.insert(groups.tile(i));
    EXPECT_EQ(all.size(), tiles);
    EXPECT_EQ(*all.rbegin(), tiles - 1);
    for (uint32_t level = 1; level < groups.levels(); ++level) {
        EXPECT_EQ(groups.first_member(level, 0), 0u);
        EXPECT_EQ(groups.first_member(level, groups.count(level)), groups.count(level - 1));
        EXPECT_EQ(groups.first_tile(level, groups.count(level)), tiles);
        for (uint32_t g = 0; g < groups.count(level); ++g) {
            const uint32_t members = groups.first_member(level, g + 1) - groups.first_member(level, g);
            EXPECT_GE(members, 1u);
            EXPECT_LE(members, 4u);
        }
    }
}

TEST(TileGroups, AreSquaresWhereTilesAre) {
    const Plane plane(8, 8, true);
    const Groups g(plane, 3);
    expect_each_once(g.groups, 64);
    ASSERT_EQ(g.groups.levels(), 4u);
    for (uint32_t level = 1; level < 4; ++level) {
        ASSERT_EQ(g.groups.count(level), 64u >> (2 * level));
        for (uint32_t i = 0; i < g.groups.count(level); ++i) {
            std::set<uint32_t> corners;
            for (uint32_t t = g.groups.first_tile(level, i); t < g.groups.first_tile(level, i + 1); ++t) {
                for (uint32_t k = 0; k < 4; ++k) corners.insert(plane.corner[4 * g.groups.tile(t) + k]);
            }
            const size_t width = (size_t{1} << level) + 1;
            EXPECT_EQ(corners.size(), width * width);
        }
    }
}

TEST(TileGroups, TilesThatAreNotGluedMeetInTheUpperLevelsOnly) {
    const Plane plane(1, 21, false);
    const Groups g(plane, 2);
    expect_each_once(g.groups, 21);
    const uint32_t counts[] = {21, 21, 21, 6, 2, 1};
    ASSERT_EQ(g.groups.levels(), 6u);
    for (uint32_t level = 0; level < 6; ++level) EXPECT_EQ(g.groups.count(level), counts[level]);
}

TEST(TileGroups, AStripEndsInOneGroup) {
    for (uint32_t tiles = 1; tiles < 40; ++tiles) {
        const Plane plane(1, tiles, true);
        const Groups g(plane, 3);
        expect_each_once(g.groups, tiles);
        EXPECT_EQ(g.groups.count(g.groups.levels() - 1), 1u);
    }
}

// One tile of 4 x 4 cells. Two corners are raised, and all samples lie on the two triangles. The finer cells on the fold are
// split across it, so they bridge it.
TEST(CellError, CountsWhereDiagonalsCross) {
    std::vector<uint32_t> mate(4, kNoMate), corner = {0, 4, 24, 20}, along = {1, 9, 23, 15}, inner = {6};
    std::vector<int32_t> step = {1, 5, -1, -5};
    std::vector<SampleValue> values;
    for (int v = 0; v < 25; ++v) {
        const int row = v / 5, column = v % 5;
        const float x = static_cast<float>(column), y = static_cast<float>(row);
        values.push_back({{x, y, std::fabs(x - y)}, 0, 0});
    }
    TileGlue glue;
    glue.mate = mate.data();
    glue.corner = corner.data();
    glue.along = along.data();
    glue.step = step.data();
    glue.inner = inner.data();
    glue.row_step = 5;
    const QuadDomain domain({1, 4, 25}, glue, values.data());
    EXPECT_NEAR(cell_error(domain, {0, 0, 0, 4, true}), 1, 1e-5);
    EXPECT_NEAR(cell_error(domain, {0, 0, 0, 4, false}), 4, 1e-5);  // at the two corners that the fold joins
    EXPECT_EQ(cell_error(domain, {0, 1, 2, 1, true}), 0);
}

}  // namespace
}  // namespace gim

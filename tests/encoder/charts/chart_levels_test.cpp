#include "encoder/charts/chart_levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "encoder/charts/multi_chart.h"
#include "format/band_code.h"
#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

Mesh surface_named(const std::string& name) {
    for (NamedMesh& m : surfaces()) {
        if (m.name == name) return std::move(m.mesh);
    }
    ADD_FAILURE() << "no mesh " << name;
    return {};
}

MultiChart multi_chart(const Mesh& mesh, uint32_t samples) {
    StageClock clock({});
    MultiChartOptions options;
    options.charts = 6;
    options.samples = samples;
    options.pack_effort = 1;
    options.fit.reset();
    auto made = make_multi_chart_image(mesh, options, clock);
    EXPECT_TRUE(made.ok()) << made.error().message;
    return std::move(made.value());
}

ChartLevels images_of(const MultiChart& made, uint32_t most_levels, uint32_t threads = 0) {
    auto images = make_chart_levels(made.image, made.atlas, made.packing, made.topology, most_levels, threads);
    EXPECT_TRUE(images.ok()) << images.error().message;
    return std::move(images.value());
}

class ChartLevelsOf : public ::testing::TestWithParam<const char*> {
  protected:
    const MultiChart made = multi_chart(surface_named(GetParam()), 6000);
    const ChartLevels images = images_of(made, 8);
};
INSTANTIATE_TEST_SUITE_P(Surfaces, ChartLevelsOf,
                         ::testing::Values("sphere-1728", "torus-576", "terrain-3200", "annulus-512", "four-pieces"),
                         [](const auto& surface) {
                             std::string name = surface.param;
                             std::erase_if(name, [](char c) { return c == '-'; });
                             return name;
                         });

TEST_P(ChartLevelsOf, BoxesHoldTheChartsWhereTheRectangleHasThem) {
    ASSERT_EQ(images.charts.size(), made.atlas.charts.size());
    uint64_t count = 0;
    for (size_t c = 0; c < images.charts.size(); ++c) {
        const ChartBox& box = images.charts[c];
        ASSERT_EQ(images.positions[c].size(), size_t{box.columns} * box.rows);
        ASSERT_EQ(images.defined[c].size(), images.positions[c].size());
        EXPECT_EQ(box.path_count, made.atlas.charts[c].paths.size());
        for (uint32_t i = 0; i < images.defined[c].size(); ++i) {
            if (!images.defined[c][i]) continue;
            const int64_t column = box.atlas_column + int64_t{i % box.columns},
                          row = box.atlas_row + int64_t{i / box.columns};
            ASSERT_TRUE(made.image.mask.at(column, row));
            ASSERT_EQ(
                images.positions[c][i],
                made.image.positions[static_cast<size_t>(row) * made.image.width() + static_cast<size_t>(column)]);
            ++count;
        }
    }
    EXPECT_EQ(count, made.image.mask.count());
    EXPECT_EQ(images.defined_count(), count);
}

TEST_P(ChartLevelsOf, BordersOfEveryLevelAreClosedWalksInTheirBoxes) {
    ASSERT_GE(images.levels.size(), 2u);
    for (uint32_t level = 0; level < images.levels.size(); ++level) {
        const LevelBorders& borders = images.levels[level];
        ASSERT_EQ(borders.loops.size(), images.charts.size());
        ASSERT_EQ(borders.lengths.size(), images.mates.size());
        size_t path = 0;
        for (size_t c = 0; c < images.charts.size(); ++c) {
            const ChartBox& box = images.charts[c];
            ASSERT_GE(box.steps(), level);
            const uint32_t columns = halved(box.columns, level), rows = halved(box.rows, level);
            const std::vector<uint32_t>& loop = borders.loops[c];
            size_t length = 0;
            for (uint32_t k = 0; k < box.path_count; ++k, ++path) {
                EXPECT_GE(borders.lengths[path], 1u);
                length += borders.lengths[path];
            }
            EXPECT_EQ(length, loop.size());
            EXPECT_EQ(std::set<uint32_t>(loop.begin(), loop.end()).size(), loop.size());
            for (size_t i = 0; i < loop.size(); ++i) {
                const uint32_t from = loop[i], to = loop[(i + 1) % loop.size()];
                ASSERT_LT(from, columns * rows);
                EXPECT_LE(std::abs(int(from % columns) - int(to % columns)), 1);
                EXPECT_LE(std::abs(int(from / columns) - int(to / columns)), 1);
            }
        }
        size_t zipper = 0;
        for (uint32_t p = 0; p < images.mates.size(); ++p) {
            if (images.mates[p] == kNoMate || images.mates[p] < p) continue;
            ASSERT_LT(zipper, borders.zippers.size());
            const auto& steps = borders.zippers[zipper++];
            const auto both = std::count(steps.begin(), steps.end(), ZipStep::kBoth);
            EXPECT_EQ(both + std::count(steps.begin(), steps.end(), ZipStep::kFirst), borders.lengths[p]);
            EXPECT_EQ(both + std::count(steps.begin(), steps.end(), ZipStep::kSecond),
                      borders.lengths[images.mates[p]]);
        }
        EXPECT_EQ(zipper, borders.zippers.size());
        if (level > 0) {
            EXPECT_LT(borders.size.vertices, images.levels[level - 1].size.vertices);
        }
    }
}

TEST(ChartLevels, NoMoreLevelsThanAskedForAndTheFinestAlways) {
    const MultiChart made = multi_chart(surface_named("torus-576"), 6000);
    const ChartLevels many = images_of(made, 8);
    for (const uint32_t most : {1u, 2u}) {
        const ChartLevels few = images_of(made, most);
        EXPECT_EQ(few.levels.size(), most);
        EXPECT_EQ(few.levels[0].loops.size(), many.levels[0].loops.size());
        EXPECT_EQ(few.levels[0].lengths, many.levels[0].lengths);
        EXPECT_EQ(few.levels[0].size.vertices, many.levels[0].size.vertices);
    }
}

TEST(ChartLevels, LevelsOfAnotherTopologyAreNotKept) {
    MultiChart made = multi_chart(surface_named("torus-576"), 6000);
    made.topology.genus += 1;
    EXPECT_EQ(images_of(made, 8).levels.size(), 1u);
}

TEST(ChartLevels, ThreadsDoNotMatter) {
    const MultiChart made = multi_chart(surface_named("tori-2"), 6000);
    const ChartLevels one = images_of(made, 8, 1), three = images_of(made, 8, 3);
    ASSERT_EQ(one.levels.size(), three.levels.size());
    for (size_t l = 0; l < one.levels.size(); ++l) {
        EXPECT_EQ(one.levels[l].loops, three.levels[l].loops);
        EXPECT_EQ(one.levels[l].zippers, three.levels[l].zippers);
    }
    EXPECT_EQ(one.positions, three.positions);
}

TEST(ChartLevels, SameTopologyAsksForManifolds) {
    TopologySummary a;
    a.manifold = true;
    a.components = 1;
    TopologySummary b = a;
    EXPECT_TRUE(same_topology(a, b));
    b.genus = 1;
    EXPECT_FALSE(same_topology(a, b));
    b = a;
    b.boundary_loops = 1;
    EXPECT_FALSE(same_topology(a, b));
    b = a;
    b.components = 2;
    EXPECT_FALSE(same_topology(a, b));
    b = a;
    b.manifold = false;
    EXPECT_FALSE(same_topology(a, b));
    EXPECT_FALSE(same_topology(b, b));
}

}  // namespace
}  // namespace gim

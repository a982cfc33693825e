#include "encoder/charts/multi_chart_image.h"

#include <gtest/gtest.h>

#include "encoder/charts/glue_charts.h"
#include "encoder/surface/topology_summary.h"

namespace gim {
namespace {

// Two squares of 3 x 3 samples, a column apart: the two halves of a sphere. Each border has 8 samples, all zipped.
// The image has 7 x 3 samples; the left loop is 0 1 2 9 16 15 14 7, the right one 4 5 6 13 20 19 18 11.
MultiChartImage pillow() {
    MultiChartImage image;
    image.mask = {7, 3, {}};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 7; ++column) image.mask.defined.push_back(column != 3);
    }
    for (uint32_t i = 0; i < 21; ++i) {
        const uint32_t row = i / 7, column = i % 7;
        // The right square is the mirror image of the left one.
        const double x = column < 3 ? column : 6 - column, y = row, z = row == 1 && column == 1 ? -1 : 0;
        image.positions.emplace_back(x, y, row == 1 && column == 5 ? 1 : z);
    }
    // Left: two paths of 4, from sample 0 to 16 and back. The right side runs the other way round. Its first path
    // begins at sample 6, the mate of 0, at index 2 of its loop; it is the mate of the left side's second path.
    image.seams.loops = {{0, 2}, {6, 2}};
    image.seams.paths = {{3, 4}, {2, 4}, {1, 4}, {0, 4}};
    image.seams.zippers.assign(2, std::vector<ZipStep>(4, ZipStep::kBoth));
    return image;
}

TopologySummary topology_of(MultiChartImage image) {
    auto gluing = glue_charts(image.mask, image.seams);
    EXPECT_TRUE(gluing.ok()) << gluing.error().message;
    image.gluing = std::move(gluing.value());
    const Mesh mesh = surface_of(image).mesh;
    return analyse_topology(mesh.triangles, mesh.positions.size()).summary;
}

TEST(MultiChartImage, ZippedSquaresMakeASphere) {
    const MultiChartImage image = pillow();
    const TopologySummary t = topology_of(image);
    EXPECT_TRUE(t.watertight);
    EXPECT_EQ(t.euler, 2);
    EXPECT_EQ(t.vertices, 10u);
    EXPECT_EQ(t.triangles, 16u);
    const auto point = glue_samples(image.mask, image.seams);
    for (size_t i = 0; i < image.positions.size(); ++i) {
        if (image.mask.defined[i]) {
            EXPECT_EQ(image.positions[i], image.positions[point.value()[i]]) << i;
        }
    }
    EXPECT_EQ(point.value()[3], kNone);
    EXPECT_EQ(point.value()[6], 0u);
    EXPECT_EQ(point.value()[18], 16u);
}

TEST(MultiChartImage, UnmatedPathsStayOpen) {
    MultiChartImage image = pillow();
    image.seams.paths = {{kNone, 4}, {2, 4}, {1, 4}, {kNone, 4}};
    image.seams.zippers.resize(1);
    const TopologySummary t = topology_of(std::move(image));
    EXPECT_TRUE(t.manifold);
    EXPECT_EQ(t.boundary_loops, 1u);
    EXPECT_EQ(t.euler, 1);
}

TEST(MultiChartImage, StepsOfOneSideFlattenTriangles) {
    MultiChartImage image = pillow();
    // The left side's second sample joins its first point. Then the right side catches up.
    image.seams.zippers[0] = {ZipStep::kFirst, ZipStep::kSecond, ZipStep::kBoth, ZipStep::kBoth, ZipStep::kBoth};
    const TopologySummary t = topology_of(std::move(image));
    EXPECT_TRUE(t.watertight);
    EXPECT_EQ(t.euler, 2);
    EXPECT_EQ(t.vertices, 9u);
    EXPECT_EQ(t.triangles, 14u);
}

TEST(MultiChartImage, RecordThatDoesNotFitIsRefused) {
    const auto refused = [](auto spoil) {
        MultiChartImage image = pillow();
        spoil(image.seams);
        return !glue_samples(image.mask, image.seams).ok();
    };
    EXPECT_FALSE(refused([](SeamRecord&) {}));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.loops.pop_back(); }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.loops[0].start = 8; }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.loops[0].path_count = 0; }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.loops[1].path_count = 3; }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.loops[1].path_count = 1; }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.paths[0].length = 5; }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.paths[0].length = 3; }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.paths[0].length = 0; }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.paths[0].length = UINT32_MAX; }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.paths.push_back({}); }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.paths[0].mate = 2; }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.paths[0].mate = 0; }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.paths[0].mate = 4; }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.zippers.pop_back(); }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.zippers.push_back({}); }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.zippers[0].pop_back(); }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.zippers[0].push_back(ZipStep::kFirst); }));
    EXPECT_TRUE(refused([](SeamRecord& s) { s.zippers[1].push_back(ZipStep::kSecond); }));
}

}  // namespace
}  // namespace gim

#include "encoder/grid_surface.h"

#include <gtest/gtest.h>

#include "encoder/topology_summary.h"
#include "tests/encoder/grid_images.h"

namespace gim {
namespace {

TopologySummary topology_of(const GeometryImage& image) {
    const auto gluing = glue_ring(image.sideband, image.side);
    EXPECT_TRUE(gluing.ok());
    std::vector<Triangle> triangles = triangulate_grid(image.positions, image.side, gluing.value());
    for (Triangle& t : triangles) {
        for (uint32_t& v : t) v = gluing.value().representative[v];
    }
    return analyse_topology(triangles, image.positions.size()).summary;
}

TEST(GridSurface, GluedTorusIsAClosedSurfaceOfGenusOne) {
    for (const uint32_t side : {5u, 17u, 33u}) {
        const TopologySummary s = topology_of(torus_image(side, 0.7, 0.3));
        EXPECT_TRUE(s.watertight) << side;
        EXPECT_EQ(s.genus, 1) << side;
        EXPECT_EQ(s.triangles, 2u * (side - 1) * (side - 1));
    }
}

TEST(GridSurface, OpenSquareHasOneBoundary) {
    const GeometryImage image = image_of(9, open_sideband(), [](double u, double v) { return Vec3(u, v, 0); });
    const TopologySummary s = topology_of(image);
    EXPECT_EQ(s.boundary_loops, 1u);
    EXPECT_EQ(s.boundary_edges, 32u);
    const auto gluing = glue_ring(image.sideband, image.side);
    EXPECT_TRUE(gluing.value().shared.empty());
    EXPECT_TRUE(gluing.value().on_input_boundary[3]);
    EXPECT_FALSE(gluing.value().on_input_boundary[10]);
}

TEST(GridSurface, BoundarySpreadsOverTheClassOfACutNode) {
    // Left and right side glued, top and bottom open: a cylinder.
    const auto gluing = glue_ring({2, 0, {{kNoMate, 1}, {3, 1}, {kNoMate, 1}, {1, 1}}}, 5);
    ASSERT_TRUE(gluing.ok());
    EXPECT_EQ(gluing.value().shared.size(), 5u);
    EXPECT_EQ(gluing.value().representative[4], 0u);
    EXPECT_TRUE(gluing.value().on_input_boundary[4]);
    EXPECT_EQ(gluing.value().representative[14], 10u);
    EXPECT_FALSE(gluing.value().on_input_boundary[14]);
}

TEST(GridSurface, ShorterDiagonalIsTaken) {
    GeometryImage image = image_of(5, open_sideband(), [](double u, double v) { return Vec3(4 * u, 4 * v, 0); });
    const auto gluing = glue_ring(image.sideband, image.side);
    ASSERT_TRUE(gluing.ok());
    const uint32_t cell = 5;  // of samples 6, 7, 11, 12
    image.at(1, 1) += Vec3(0.2, 0.2, 0);
    const auto main = split_cell(image.positions, image.side, gluing.value(), cell);
    EXPECT_EQ(main[0], (Triangle{6, 7, 12}));
    EXPECT_EQ(main[1], (Triangle{6, 12, 11}));
    image.at(1, 1) -= Vec3(0.4, 0.4, 0);
    EXPECT_EQ(split_cell(image.positions, image.side, gluing.value(), cell)[0], (Triangle{6, 7, 11}));
    EXPECT_EQ(triangulate_grid(image.positions, image.side, gluing.value())[2 * cell], (Triangle{6, 7, 11}));
}

TEST(GridSurface, InconsistentSeamsAreRefused) {
    EXPECT_FALSE(glue_ring({2, 0, {{2, 1}, {3, 1}, {0, 1}}}, 5).ok());  // ring not filled
    EXPECT_FALSE(glue_ring({9, 0, {{kNoMate, 32}}}, 5).ok());           // node grid finer than the image
    EXPECT_FALSE(glue_ring({3, 0, {{1, 3}, {0, 5}}}, 5).ok());          // mates of different lengths
    EXPECT_FALSE(glue_ring({2, 0, {{7, 2}, {0, 2}}}, 5).ok());          // no such mate
}

}  // namespace
}  // namespace gim

#include "encoder/image/gluing.h"

#include <gtest/gtest.h>

#include "encoder/squares/square_image.h"
#include "encoder/surface/topology_summary.h"
#include "tests/encoder/grid_images.h"

namespace gim {
namespace {

TopologySummary topology_of(const GeometryImage& image) {
    const Mesh mesh = surface_of(image).mesh;
    return analyse_topology(mesh.triangles, mesh.positions.size()).summary;
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
    const SquareImage image = image_of(9, open_sideband(), [](double u, double v) { return Vec3(u, v, 0); });
    const TopologySummary s = topology_of(image);
    EXPECT_EQ(s.boundary_loops, 1u);
    EXPECT_EQ(s.boundary_edges, 32u);
    EXPECT_TRUE(image.gluing.shared.empty());
    EXPECT_TRUE(image.gluing.on_input_boundary[3]);
    EXPECT_FALSE(image.gluing.on_input_boundary[10]);
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
    SquareImage image = image_of(5, open_sideband(), [](double u, double v) { return Vec3(4 * u, 4 * v, 0); });
    const uint32_t cell = 5;  // of samples 6, 7, 11, 12
    image.at(1, 1) += Vec3(0.2, 0.2, 0);
    const auto main = split_cell(image.positions, image.gluing, cell);
    EXPECT_EQ(main[0], (Triangle{6, 7, 12}));
    EXPECT_EQ(main[1], (Triangle{6, 12, 11}));
    image.at(1, 1) -= Vec3(0.4, 0.4, 0);
    EXPECT_EQ(split_cell(image.positions, image.gluing, cell)[0], (Triangle{6, 7, 11}));
    EXPECT_EQ(triangulate_grid(image.positions, image.gluing).triangles[2 * cell], (Triangle{6, 7, 11}));
}

TEST(GridSurface, ChartsMakeAClosedSurfaceOfOneVertexAPoint) {
    const MultiChartImage image = sphere_charts(9);
    const GridFaces faces = triangulate_grid(image.positions, image.gluing);
    const Surface surface = surface_of(image);
    ASSERT_EQ(faces.triangles.size(), surface.mesh.triangles.size());
    for (size_t f = 0; f < faces.triangles.size(); ++f) {
        for (size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(image.gluing.representative[faces.triangles[f][k]], surface.sample[surface.mesh.triangles[f][k]]);
        }
        EXPECT_EQ(split_cell(image.positions, image.gluing, faces.slot[f] / 2)[faces.slot[f] % 2], faces.triangles[f]);
    }
    EXPECT_TRUE(topology_of(image).watertight);
}

TEST(GridSurface, CellsWithoutASampleOrWithTwoAtOnePointHaveFewerTriangles) {
    const MultiChartImage image = sphere_charts(9);
    const GridGluing gluing = glue_charts(image.mask, image.seams).value();
    const auto count = [&](uint32_t cell) {
        const auto halves = split_cell(image.positions, gluing, cell);
        return (halves[0] != kNoFace) + (halves[1] != kNoFace);
    };
    constexpr uint32_t kCellsAcross = 18;
    EXPECT_EQ(count(0), 1);  // samples 0 and 1 are one point
    EXPECT_EQ(count(1), 2);
    EXPECT_EQ(count(7 * kCellsAcross), 1);  // without its lower left sample
    EXPECT_EQ(count(8), 0);                 // beside the gap
    EXPECT_EQ(count(7 * kCellsAcross + 9), 0);
}

TEST(GridSurface, EdgesJoinNeighboursOfAChartOnly) {
    const MultiChartImage image = sphere_charts(9);
    const GridGluing gluing = glue_charts(image.mask, image.seams).value();
    constexpr uint32_t kWidth = 19;
    EXPECT_EQ(gluing.edges[0], GridGluing::kSouth);  // the next sample is the same point
    EXPECT_EQ(gluing.edges[1], GridGluing::kSouth | GridGluing::kEast);
    EXPECT_EQ(gluing.edges[8], GridGluing::kSouth | GridGluing::kWest);  // the gap
    EXPECT_EQ(gluing.edges[9], 0);                                       // undefined
    EXPECT_EQ(gluing.edges[kWidth + 4],
              GridGluing::kNorth | GridGluing::kSouth | GridGluing::kWest | GridGluing::kEast);
    EXPECT_EQ(gluing.edges[7 * kWidth], GridGluing::kNorth | GridGluing::kEast);      // above the missing corner
    EXPECT_EQ(gluing.edges[8 * kWidth + 1], GridGluing::kNorth | GridGluing::kEast);  // right of it
}

TEST(GridSurface, PathsWithoutMateAreInputBoundaries) {
    MultiChartImage image = sphere_charts(9);
    image.seams.paths[0].mate = image.seams.paths[3].mate = kNoMate;
    image.seams.zippers.erase(image.seams.zippers.begin());
    const GridGluing gluing = glue_charts(image.mask, image.seams).value();
    EXPECT_TRUE(gluing.on_input_boundary[4]);
    EXPECT_TRUE(gluing.on_input_boundary[8 * 19 + 8]);  // its end node
    EXPECT_FALSE(gluing.on_input_boundary[8 * 19 + 4]);
    EXPECT_FALSE(gluing.on_input_boundary[4 * 19 + 4]);
}

TEST(GridSurface, InconsistentSeamsAreRefused) {
    EXPECT_FALSE(glue_ring({2, 0, {{2, 1}, {3, 1}, {0, 1}}}, 5).ok());  // ring not filled
    EXPECT_FALSE(glue_ring({9, 0, {{kNoMate, 32}}}, 5).ok());           // node grid finer than the image
    EXPECT_FALSE(glue_ring({3, 0, {{1, 3}, {0, 5}}}, 5).ok());          // mates of different lengths
    EXPECT_FALSE(glue_ring({2, 0, {{7, 2}, {0, 2}}}, 5).ok());          // no such mate
}

}  // namespace
}  // namespace gim

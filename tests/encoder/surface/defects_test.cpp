#include "encoder/surface/defects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "corpus/generators.h"
#include "gim/encoder.h"

namespace gim {
namespace {

constexpr uint32_t kCells = 20;

CompareOptions with_defects() {
    CompareOptions options;
    options.samples = 100000;
    options.defects = true;
    return options;
}

Comparison compared(const TriangleMesh& reference, const TriangleMesh& test) {
    const auto result = compare(reference, test, with_defects());
    EXPECT_TRUE(result.ok()) << result.error().message;
    return result.ok() ? result.value() : Comparison{};
}

Defects defects_of(const TriangleMesh& reference, const TriangleMesh& test) {
    return compared(reference, test).defects.value_or(Defects{});
}

uint32_t grid_vertex(uint32_t column, uint32_t row) { return row * (kCells + 1) + column; }

// A flat square of kCells * kCells unit cells that looks along z. Diagonals run along (1, 1).
TriangleMesh grid() {
    TriangleMesh mesh;
    for (uint32_t row = 0; row <= kCells; ++row) {
        for (uint32_t column = 0; column <= kCells; ++column) {
            mesh.positions.push_back({static_cast<double>(column), static_cast<double>(row), 0});
        }
    }
    for (uint32_t row = 0; row < kCells; ++row) {
        for (uint32_t column = 0; column < kCells; ++column) {
            const uint32_t a = grid_vertex(column, row), b = grid_vertex(column + 1, row),
                           c = grid_vertex(column + 1, row + 1), d = grid_vertex(column, row + 1);
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
    }
    return mesh;
}

// Moves a vertex to the right by more than a cell. The two triangles on its right fold over. Each then has the area
// (distance - 1) / 2, and four edges are folded back.
void fold_at(TriangleMesh& mesh, uint32_t column, uint32_t row, double distance) {
    mesh.positions[grid_vertex(column, row)][0] += distance;
}

TriangleMesh folded_grid() {
    TriangleMesh mesh = grid();
    fold_at(mesh, 3, 3, 1.5);
    fold_at(mesh, 12, 4, 1.8);
    fold_at(mesh, 7, 15, 1.2);
    return mesh;
}

TEST(Defects, AreMeasuredOnlyIfAskedFor) {
    const auto plain = compare(grid(), grid(), {});
    ASSERT_TRUE(plain.ok());
    EXPECT_FALSE(plain.value().defects.has_value());
    EXPECT_TRUE(compared(grid(), grid()).defects.has_value());
}

TEST(Defects, EqualMeshesHaveNone) {
    for (const TriangleMesh& mesh : {grid(), corpus::sphere(12), corpus::limbed_blob(20)}) {
        const Defects defects = defects_of(mesh, mesh);
        EXPECT_EQ(defects.folded_faces, 0u);
        EXPECT_EQ(defects.folded_area, 0);
        EXPECT_EQ(defects.off_by_20, 0);
        EXPECT_EQ(defects.off_by_45, 0);
        EXPECT_LT(defects.normals_p99, 1e-4);
        EXPECT_EQ(defects.folded_back_edges, defects.folded_back_edges_of_reference);
        EXPECT_EQ(defects.largest_fold.faces, 0u);
        EXPECT_EQ(defects.largest_fold.area, 0);
    }
}

TEST(Defects, FacesThatFoldOverAreCountedAndWeighed) {
    const Defects defects = defects_of(grid(), folded_grid());
    EXPECT_EQ(defects.folded_faces, 6u);
    // The folds cover their area three times instead of once: the folded layer and two that do not look away.
    const double folded = 0.5 + 0.8 + 0.2, all = kCells * kCells + 2 * folded;
    EXPECT_NEAR(defects.folded_area, folded / all, 1e-4);
    EXPECT_EQ(defects.folded_back_edges, 12u);
    EXPECT_EQ(defects.folded_back_edges_of_reference, 0u);
}

TEST(Defects, TheLargestFoldIsFound) {
    const Defects::Fold fold = defects_of(grid(), folded_grid()).largest_fold;
    EXPECT_EQ(fold.faces, 2u);
    EXPECT_NEAR(fold.area, 0.8, 1e-12);
    EXPECT_NEAR(fold.center[0], 12 + 1.1, 1e-12);
    EXPECT_NEAR(fold.center[1], 4, 1e-12);
    EXPECT_EQ(fold.center[2], 0);
}

TEST(Defects, FoldsOfOneCornerAreOne) {
    TriangleMesh mesh = grid();
    fold_at(mesh, 3, 3, 1.5);
    fold_at(mesh, 4, 4, 1.5);  // shares a corner with the fold before it
    const Defects defects = defects_of(grid(), mesh);
    EXPECT_EQ(defects.largest_fold.faces, defects.folded_faces);
    EXPECT_GT(defects.folded_faces, 2u);
}

TEST(Defects, RepeatedVerticesChangeNothing) {
    const Defects whole = defects_of(grid(), folded_grid());
    const Defects apart = defects_of(grid(), corpus::soup(folded_grid()));
    EXPECT_EQ(apart.folded_faces, whole.folded_faces);
    EXPECT_EQ(apart.folded_back_edges, 12u);
    EXPECT_EQ(apart.largest_fold.faces, 2u);
    EXPECT_NEAR(apart.largest_fold.area, whole.largest_fold.area, 1e-12);
    EXPECT_NEAR(apart.off_by_45, whole.off_by_45, 1e-12);
}

TEST(Defects, OnlySharpFoldsOfAnEdgeCount) {
    // Two faces that meet along the y axis. The right one is lifted by `degrees`, up to lying upon the left one.
    const auto count = [](double degrees) {
        const double angle = degrees * std::numbers::pi / 180;
        const TriangleMesh hinge{{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {std::cos(angle), 0, std::sin(angle)}},
                                 {{0, 1, 2}, {1, 0, 3}}};
        const Defects defects = defects_of(hinge, hinge);
        EXPECT_EQ(defects.folded_back_edges, defects.folded_back_edges_of_reference);
        return defects.folded_back_edges;
    };
    EXPECT_EQ(count(0), 0u);
    EXPECT_EQ(count(90), 0u);
    EXPECT_EQ(count(149), 0u);
    EXPECT_EQ(count(151), 1u);
    EXPECT_EQ(count(179), 1u);
}

// Flat rectangles of unit height, far apart along x. Each is turned about its own middle, parallel to y.
struct Strip {
    double width = 1, degrees = 0, lift = 0;
};
TriangleMesh strips(const std::vector<Strip>& wanted) {
    TriangleMesh mesh;
    double middle = 0;
    for (const Strip& strip : wanted) {
        const double angle = strip.degrees * std::numbers::pi / 180, x = strip.width / 2 * std::cos(angle),
                     z = strip.width / 2 * std::sin(angle);
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        for (const double y : {0.0, 1.0}) {
            mesh.positions.push_back({middle - x, y, strip.lift - z});
            mesh.positions.push_back({middle + x, y, strip.lift + z});
        }
        mesh.triangles.push_back({first, first + 1, first + 3});
        mesh.triangles.push_back({first, first + 3, first + 2});
        middle += 10;
    }
    return mesh;
}

TEST(Defects, SharesAndPercentilesOfNormalsAreThoseOfTheirAreas) {
    const TriangleMesh flat = strips({{0.93}, {0.03}, {0.04}});
    const TriangleMesh tilted = strips({{0.93}, {0.03, 30}, {0.04, 60}});
    const Defects defects = defects_of(flat, tilted);
    EXPECT_NEAR(defects.off_by_20, 0.07, 1e-4);
    EXPECT_NEAR(defects.off_by_45, 0.04, 1e-4);
    EXPECT_NEAR(defects.normals_p95, 30, 1e-6);
    EXPECT_NEAR(defects.normals_p99, 60, 1e-6);
    EXPECT_EQ(defects.folded_faces, 0u);
}

TEST(Defects, SharesAreOfTheTestSurface) {
    // A roof of 60 degrees over the left half of the ground has two thirds of the area. Its ridge shares no vertices.
    const double height = std::tan(std::numbers::pi / 3);
    const TriangleMesh roof{
        {{-1, 0, 0}, {0, 0, height}, {0, 2, height}, {-1, 2, 0}, {0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}},
        {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}};
    const TriangleMesh ground{{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    EXPECT_NEAR(defects_of(ground, roof).off_by_20, 2.0 / 3, 1e-4);
    EXPECT_NEAR(defects_of(ground, roof).off_by_45, 2.0 / 3, 1e-4);
}

TEST(Defects, DistancesAreOverTheRms) {
    // Half a percent of the area is 1 away, the rest 0.1.
    const TriangleMesh flat = strips({{0.995}, {0.005}});
    const TriangleMesh lifted = strips({{0.995, 0, 0.1}, {0.005, 0, 1}});
    const Comparison comparison = compared(flat, lifted);
    ASSERT_TRUE(comparison.defects);
    const double rms = std::sqrt(0.995 * 0.01 + 0.005);
    EXPECT_NEAR(comparison.defects->max_over_rms, 1 / rms, 1e-2);
    EXPECT_NEAR(comparison.defects->p999_over_rms, 1 / rms, 1e-2);
}

TEST(Defects, ThreadsChangeNothing) {
    const TriangleMesh a = corpus::limbed_blob(24), b = corpus::roughened(a, 0.03, 1);
    CompareOptions options = with_defects();
    options.threads = 1;
    const auto one = compare(a, b, options);
    options.threads = 2;
    const auto two = compare(a, b, options);
    ASSERT_TRUE(one.ok() && two.ok());
    const Defects &x = *one.value().defects, &y = *two.value().defects;
    EXPECT_EQ(x.folded_faces, y.folded_faces);
    EXPECT_EQ(x.folded_area, y.folded_area);
    EXPECT_EQ(x.off_by_20, y.off_by_20);
    EXPECT_EQ(x.off_by_45, y.off_by_45);
    EXPECT_EQ(x.normals_p95, y.normals_p95);
    EXPECT_EQ(x.normals_p99, y.normals_p99);
    EXPECT_EQ(x.p999_over_rms, y.p999_over_rms);
    EXPECT_EQ(x.max_over_rms, y.max_over_rms);
    EXPECT_EQ(x.folded_back_edges, y.folded_back_edges);
    EXPECT_EQ(x.largest_fold.center, y.largest_fold.center);
    EXPECT_EQ(map_defects(a, b, 1).value().off, map_defects(a, b, 2).value().off);
}

TEST(Defects, TheMapShowsWhatIsCounted) {
    const auto map = map_defects(grid(), folded_grid());
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_EQ(std::count(map.value().folded.begin(), map.value().folded.end(), 1), 6);
    EXPECT_EQ(map.value().folded.size(), grid().triangles.size());
    EXPECT_EQ(map.value().folded_back.size(), 12u);
    EXPECT_EQ(map.value().off.size(), grid().positions.size());
    EXPECT_NEAR(map.value().off[grid_vertex(17, 17)], 0, 1e-4);
}

TEST(Defects, TheMapHasTheAngleAtEachVertex) {
    TriangleMesh tilted = strips({{1}, {1, 30}, {1, 60}});
    tilted.positions.push_back({0, 0, 0});  // used by no triangle
    const auto map = map_defects(strips({{1}, {1}, {1}}), tilted);
    ASSERT_TRUE(map.ok()) << map.error().message;
    for (size_t v = 0; v < 12; ++v) {
        EXPECT_NEAR(map.value().off[v], 30.0 * static_cast<double>(v / 4), 1e-4) << v;
    }
    EXPECT_EQ(map.value().off[12], 0);
}

TEST(Defects, TheMapRefusesUnusableMeshes) {
    EXPECT_FALSE(map_defects(grid(), {}).ok());
    EXPECT_FALSE(map_defects({}, grid()).ok());
}

TEST(Defects, PercentileIsAValueThatThisPartDoesNotExceed) {
    std::vector<double> values;
    for (int i = 100; i >= 1; --i) values.push_back(i);
    EXPECT_EQ(percentile(values, 0.95), 95);
    EXPECT_EQ(percentile(values, 0.951), 96);
    EXPECT_EQ(percentile(values, 1), 100);
    EXPECT_EQ(percentile(values, 0), 1);
}

}  // namespace
}  // namespace gim

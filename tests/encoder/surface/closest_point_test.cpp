#include "encoder/surface/closest_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace gim {
namespace {

// The engine's raw output is the same everywhere; distributions are not.
double unit(std::mt19937_64& engine) { return static_cast<double>(engine() >> 11) * 0x1p-53; }
Vec3 point_in_cube(std::mt19937_64& engine) {
    return {2 * unit(engine) - 1, 2 * unit(engine) - 1, 2 * unit(engine) - 1};
}

// Small triangles anywhere in the cube, some without area.
Mesh random_soup(uint32_t count, uint64_t seed) {
    std::mt19937_64 engine(seed);
    Mesh mesh;
    for (uint32_t f = 0; f < count; ++f) {
        const Vec3 at = point_in_cube(engine);
        std::array<Vec3, 3> corners;
        for (Vec3& corner : corners) corner = at + 0.05 * point_in_cube(engine);
        if (f % 17 == 0) corners[2] = 0.5 * (corners[0] + corners[1]);
        if (f % 31 == 0) corners[1] = corners[2] = corners[0];
        for (const Vec3& corner : corners) mesh.positions.push_back(corner);
        mesh.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    }
    return mesh;
}

// Nearest point by dense search over the triangle, then over every triangle.
ClosestPoint search_all(const Mesh& mesh, const Vec3& query) {
    ClosestPoint best;
    best.squared_distance = std::numeric_limits<double>::infinity();
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        ClosestPoint found =
            closest_point_on_triangle(query, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
        if (found.squared_distance < best.squared_distance) {
            best = found;
            best.triangle = f;
        }
    }
    return best;
}

TEST(ClosestPointOnTriangle, NoPointOfTheTriangleIsNearer) {
    std::mt19937_64 engine(3);
    for (int round = 0; round < 300; ++round) {
        const Vec3 a = point_in_cube(engine), b = point_in_cube(engine);
        const double flatness = round % 3 == 0 ? 1.0 : round % 3 == 1 ? 1e-7 : 0.0;
        const Vec3 c = a + 0.7 * (b - a) + flatness * (point_in_cube(engine) - a);
        const Vec3 query = 2 * point_in_cube(engine);
        const ClosestPoint found = closest_point_on_triangle(query, a, b, c);
        EXPECT_NEAR(found.squared_distance, (query - found.point).squaredNorm(), 1e-12);
        const auto& [u, v, w] = found.barycentric;
        EXPECT_GE(std::min({u, v, w}), 0);
        EXPECT_NEAR(u + v + w, 1, 1e-12);
        EXPECT_NEAR((u * a + v * b + w * c - found.point).norm(), 0, 1e-12);
        for (int i = 0; i <= 20; ++i) {
            for (int j = 0; i + j <= 20; ++j) {
                const Vec3 other = a + (i / 20.0) * (b - a) + (j / 20.0) * (c - a);
                EXPECT_LE(found.squared_distance, (query - other).squaredNorm() + 1e-12);
            }
        }
    }
}

TEST(ClosestPointOnTriangle, RegionsShowInTheBarycentricCoordinates) {
    const Vec3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
    const auto coordinates = [&](const Vec3& query) { return closest_point_on_triangle(query, a, b, c).barycentric; };
    EXPECT_EQ(coordinates({-1, -1, 2}), (std::array<double, 3>{1, 0, 0}));
    EXPECT_EQ(coordinates({6, -1, 0}), (std::array<double, 3>{0, 1, 0}));
    EXPECT_EQ(coordinates({1, -3, 5}), (std::array<double, 3>{0.75, 0.25, 0}));
    EXPECT_EQ(coordinates({3, 3, 1}), (std::array<double, 3>{0, 0.5, 0.5}));
    EXPECT_EQ(coordinates({1, 1, 9}), (std::array<double, 3>{0.5, 0.25, 0.25}));
}

TEST(ClosestPointOnTriangle, FarAboveASoundTriangleTheFootIsStillExact) {
    const ClosestPoint found = closest_point_on_triangle({0.25, 0.25, 1e7}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    EXPECT_NEAR((found.point - Vec3(0.25, 0.25, 0)).norm(), 0, 1e-8);
}

TEST(ClosestPointTree, AgreesWithSearchingEveryTriangle) {
    for (const uint32_t count : {1u, 4u, 5u, 37u, 3000u}) {
        const Mesh mesh = random_soup(count, count);
        const ClosestPointTree tree(mesh);
        std::mt19937_64 engine(7);
        for (int round = 0; round < 300; ++round) {
            const Vec3 query = (round % 10 == 0 ? 100.0 : 1.2) * point_in_cube(engine);
            const ClosestPoint expected = search_all(mesh, query), found = tree.find(query);
            ASSERT_EQ(found.squared_distance, expected.squared_distance);
            ASSERT_EQ(found.triangle, expected.triangle);
        }
    }
}

TEST(ClosestPointTree, HintsAndThreadsChangeNothing) {
    const Mesh mesh = random_soup(5000, 1);
    const ClosestPointTree tree(mesh), tree_of_one_thread(mesh, 1);
    std::mt19937_64 engine(9);
    std::vector<Vec3> queries;
    std::vector<uint32_t> hints;
    for (int i = 0; i < 4000; ++i) {
        queries.push_back(point_in_cube(engine));
        hints.push_back(i % 5 == 0 ? kNone : static_cast<uint32_t>(engine() % 6000));
    }
    const auto all = tree.find_all(queries, 2), hinted = tree_of_one_thread.find_all(queries, 1, hints);
    for (size_t i = 0; i < queries.size(); ++i) {
        const ClosestPoint one = tree.find(queries[i]);
        for (const ClosestPoint& other : {all[i], hinted[i]}) {
            ASSERT_EQ(other.triangle, one.triangle);
            ASSERT_EQ(other.squared_distance, one.squared_distance);
            ASSERT_EQ(other.barycentric, one.barycentric);
        }
    }
}

void expect_same(const ClosestPoint& a, const ClosestPoint& b) {
    EXPECT_EQ(a.triangle, b.triangle);
    EXPECT_EQ(a.point, b.point);
    EXPECT_EQ(a.squared_distance, b.squared_distance);
}

TEST(ClosestPointTree, ARefittedTreeAnswersAsANewOne) {
    const Mesh old = random_soup(500, 5);
    // Another place for every triangle, another size for the whole, and everything in one point.
    Mesh elsewhere = random_soup(500, 6), larger = old, point = old;
    for (Vec3& p : larger.positions) p = 100 * p + Vec3(7, 0, -3);
    for (Vec3& p : point.positions) p = Vec3(1, 2, 3);
    std::mt19937_64 engine(7);
    for (const Mesh& now : {elsewhere, larger, point, old}) {
        ClosestPointTree refitted(old);
        refitted.refit(now, 2);
        const ClosestPointTree fresh(now);
        for (int k = 0; k < 200; ++k) {
            const Vec3 query = 3 * point_in_cube(engine);
            expect_same(refitted.find(query), fresh.find(query));
        }
    }
}

TEST(ClosestPointTree, ATreeMayBeRefittedAgainAndAgain) {
    const Mesh first = random_soup(300, 8);
    ClosestPointTree tree(first);
    for (uint64_t seed = 9; seed < 13; ++seed) tree.refit(random_soup(300, seed));
    tree.refit(first);
    const ClosestPointTree fresh(first);
    std::mt19937_64 engine(10);
    for (int k = 0; k < 200; ++k) {
        const Vec3 query = point_in_cube(engine);
        expect_same(tree.find(query), fresh.find(query));
    }
}

TEST(ClosestPointTree, EquallyNearTrianglesGiveTheSmallestIndex) {
    // A fan around the origin, listed twice and in an order that differs from the tree's.
    Mesh mesh;
    mesh.positions.push_back(Vec3::Zero());
    for (int i = 0; i < 12; ++i) mesh.positions.emplace_back(std::cos(i * 0.5), std::sin(i * 0.5), 0);
    for (int repeat = 0; repeat < 2; ++repeat) {
        for (uint32_t i = 0; i < 12; ++i) mesh.triangles.push_back({0, 1 + (i * 5) % 12, 1 + (i * 5 + 1) % 12});
    }
    const ClosestPointTree tree(mesh);
    for (uint32_t hint = 0; hint < mesh.triangles.size(); ++hint) EXPECT_EQ(tree.find({0, 0, 3}, hint).triangle, 0u);
}

TEST(ClosestPointTree, FarOffsetsAndExtremeScalesKeepTheirDigits) {
    const Mesh unit_mesh = random_soup(800, 4);
    std::mt19937_64 engine(5);
    for (const auto& [scale, offset] : {std::pair{1e-30, 0.0}, {1e30, 0.0}, {1.0, 4194304.0}, {1e-150, 0.0}}) {
        Mesh mesh = unit_mesh;
        for (Vec3& p : mesh.positions) p = scale * p + Vec3::Constant(offset);
        const ClosestPointTree tree(mesh);
        for (int round = 0; round < 100; ++round) {
            const Vec3 query = scale * 1.5 * point_in_cube(engine) + Vec3::Constant(offset);
            EXPECT_EQ(tree.find(query).triangle, search_all(mesh, query).triangle) << scale << " " << offset;
        }
    }
}

TEST(ClosestPointTree, QueriesFarAwayFindTheirPointAndOpenFewBoxes) {
    // From far away all boxes are at the same distance up to the last digits. Without care every triangle is visited,
    // and this many queries never end.
    const Mesh mesh = random_soup(100000, 12);
    const ClosestPointTree tree(mesh);
    std::mt19937_64 engine(13);
    std::vector<Vec3> queries;
    for (int i = 0; i < 100000; ++i) queries.push_back(Vec3(3e6, -5e6, 100) + 1e4 * point_in_cube(engine));
    const std::vector<ClosestPoint> found = tree.find_all(queries);
    for (size_t i = 0; i < 20; ++i) {
        const ClosestPoint expected = search_all(mesh, queries[i]);
        EXPECT_LE(found[i].squared_distance, expected.squared_distance * (1 + 1e-14));
    }
}

TEST(ClosestPointTree, AnEmptyMeshHasNoClosestPoint) {
    ClosestPointTree empty{Mesh{}};
    empty.refit(Mesh{});
    EXPECT_EQ(empty.find(Vec3(1, 2, 3)).triangle, kNone);
    EXPECT_EQ(ClosestPointTree(Mesh{}).find({0, 0, 0}).triangle, kNone);
}

TEST(ClosestPointTree, CoincidentTrianglesDoNotBreakTheBuild) {
    Mesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {}};
    for (int i = 0; i < 20000; ++i) mesh.triangles.push_back({0, 1, 2});
    const ClosestPoint found = ClosestPointTree(mesh).find({0.2, 0.2, 1});
    EXPECT_EQ(found.triangle, 0u);
    EXPECT_DOUBLE_EQ(found.squared_distance, 1);
}

}  // namespace
}  // namespace gim

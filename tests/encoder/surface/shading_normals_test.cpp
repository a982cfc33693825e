#include "encoder/surface/shading_normals.h"

#include <gtest/gtest.h>

#include "corpus/generators.h"

namespace gim {
namespace {

Mesh as_mesh(const TriangleMesh& input) {
    Mesh mesh;
    for (const auto& p : input.positions) mesh.positions.emplace_back(p[0], p[1], p[2]);
    mesh.triangles = input.triangles;
    return mesh;
}

TEST(ShadingNormals, OfASpherePointAwayFromItsCentre) {
    const Mesh mesh = as_mesh(corpus::sphere(24));
    const std::vector<Vec3> normals = shading_normals(mesh, NormalWeight::kArea);
    for (size_t v = 0; v < normals.size(); ++v) EXPECT_GT(normals[v].dot(mesh.positions[v].normalized()), 0.998) << v;
}

TEST(ShadingNormals, VerticesAtOnePositionShareOne) {
    const TriangleMesh sphere = corpus::sphere(5);
    const Mesh whole = as_mesh(sphere), apart = as_mesh(corpus::soup(sphere));
    const std::vector<Vec3> expected = shading_normals(whole, NormalWeight::kArea),
                            normals = shading_normals(apart, NormalWeight::kArea);
    for (size_t f = 0; f < whole.triangles.size(); ++f) {
        for (size_t k = 0; k < 3; ++k) {
            EXPECT_LT((normals[apart.triangles[f][k]] - expected[whole.triangles[f][k]]).norm(), 1e-12);
        }
    }
}

TEST(ShadingNormals, PositiveAndNegativeZeroAreOnePosition) {
    const Mesh mesh{{{0.0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}, {3, 4, 5}}};
    const std::vector<Vec3> normals = shading_normals(mesh, NormalWeight::kArea);
    EXPECT_EQ(normals[0], normals[3]);
    EXPECT_NE(normals[1], normals[5]);
}

TEST(ShadingNormals, LargeTrianglesCountForMore) {
    // At the origin a triangle of area 1 that looks along z meets one of area 3 that looks along x.
    const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}}, {{0, 1, 2}, {0, 2, 3}}};
    EXPECT_LT((shading_normals(mesh, NormalWeight::kArea)[0] - Vec3(3, 0, 1).normalized()).norm(), 1e-12);
}

TEST(ShadingNormals, WideAnglesCountForMoreIfAskedTo) {
    // At the origin a right angle that looks along z meets one of 45 degrees that looks along x, whatever their areas.
    const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 7, 7}}, {{0, 1, 2}, {0, 2, 3}}};
    EXPECT_LT((shading_normals(mesh, NormalWeight::kAngle)[0] - Vec3(1, 0, 2).normalized()).norm(), 1e-12);
}

TEST(ShadingNormals, AMissingOneCountsAsARightAngle) {
    EXPECT_NEAR(degrees_between({1, 0, 0}, {0, 1, 0}), 90, 1e-12);
    EXPECT_NEAR(degrees_between({1, 0, 0}, {-1, 0, 0}), 180, 1e-12);
    EXPECT_EQ(degrees_between({0, 0, 1}, {0, 0, 1}), 0);
    EXPECT_EQ(degrees_between({0, 0, 1}, {0, 0, 0}), 90);
}

TEST(ShadingNormals, InsideATriangleTheyAreInterpolatedAndOfUnitLength) {
    const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const std::vector<Vec3> normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    EXPECT_LT((shading_normal_at(mesh, normals, 0, {0.5, 0.5, 0}) - Vec3(1, 1, 0).normalized()).norm(), 1e-15);
    EXPECT_LT((shading_normal_at(mesh, normals, 0, {0, 0, 1}) - Vec3(0, 0, 1)).norm(), 1e-15);
}

TEST(ShadingNormals, WhereTheyCancelTheTriangleDecides) {
    const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}, {0, 0, 1}}};  // both sides, and no area
    const std::vector<Vec3> normals = shading_normals(mesh, NormalWeight::kArea);
    for (const Vec3& n : normals) EXPECT_TRUE(n.isZero());
    EXPECT_EQ(shading_normal_at(mesh, normals, 0, {0.2, 0.3, 0.5}), Vec3(0, 0, 1));
    EXPECT_EQ(shading_normal_at(mesh, normals, 1, {0.2, 0.3, 0.5}), Vec3(0, 0, -1));
    EXPECT_TRUE(shading_normal_at(mesh, normals, 2, {0.2, 0.3, 0.5}).isZero());
}

}  // namespace
}  // namespace gim

#include "encoder/surface/surface_samples.h"

#include <gtest/gtest.h>

#include "corpus/generators.h"

namespace gim {
namespace {

Mesh to_mesh(const TriangleMesh& input) {
    Mesh mesh;
    for (const auto& p : input.positions) mesh.positions.emplace_back(p[0], p[1], p[2]);
    mesh.triangles = input.triangles;
    return mesh;
}

TEST(SurfaceSamples, EveryTriangleGetsItsShareToWithinTwo) {
    const Mesh mesh = to_mesh(corpus::torus(40, 20, 0.7, 0.3));
    const uint32_t count = 50000;
    const SurfaceSamples samples = sample_by_area(mesh, count, 5);
    ASSERT_EQ(samples.points.size(), count);
    std::vector<double> got(mesh.triangles.size(), 0);
    for (const uint32_t f : samples.triangles) ++got[f];
    for (uint32_t f = 0; f < got.size(); ++f) EXPECT_NEAR(got[f], face_area(mesh, f) / samples.area * count, 2.0);
}

TEST(SurfaceSamples, PointsLieInTheirTriangles) {
    const Mesh mesh = to_mesh(corpus::limbed_blob(20));
    const SurfaceSamples samples = sample_by_area(mesh, 3000, 1);
    for (size_t k = 0; k < samples.points.size(); ++k) {
        const Triangle& t = mesh.triangles[samples.triangles[k]];
        const Vec2& b = samples.barycentrics[k];
        ASSERT_GE(b.minCoeff(), 0);
        ASSERT_LE(b.sum(), 1);
        const Vec3 point =
            (1 - b.sum()) * mesh.positions[t[0]] + b[0] * mesh.positions[t[1]] + b[1] * mesh.positions[t[2]];
        ASSERT_NEAR((point - samples.points[k]).norm(), 0, 1e-12);
    }
}

TEST(SurfaceSamples, IntegratesOverASquareMuchBetterThanChance) {
    const Mesh square{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, {{0, 1, 2}, {0, 2, 3}}};
    const SurfaceSamples samples = sample_by_area(square, 10000, 3);
    double mean = 0;
    for (const Vec3& p : samples.points) mean += p[0] * p[0] * p[1] / 10000;
    EXPECT_NEAR(mean, 1.0 / 6, 5e-4);  // chance alone: about 2e-3
}

TEST(SurfaceSamples, OnlyTheSeedChangesThem) {
    const Mesh mesh = to_mesh(corpus::sphere(8));
    const SurfaceSamples one = sample_by_area(mesh, 30000, 2, 1), two = sample_by_area(mesh, 30000, 2, 2);
    EXPECT_EQ(one.points, two.points);
    EXPECT_EQ(one.triangles, two.triangles);
    EXPECT_NE(one.points, sample_by_area(mesh, 30000, 3, 1).points);
}

TEST(SurfaceSamples, TrianglesWithoutAreaGetNone) {
    Mesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 0, 1}, {0, 1, 2}, {1, 1, 2}, {2, 2, 2}}};
    for (const uint32_t f : sample_by_area(mesh, 1000, 1).triangles) ASSERT_EQ(f, 1u);
    mesh.triangles = {{0, 0, 1}};
    EXPECT_TRUE(sample_by_area(mesh, 1000, 1).points.empty());
    EXPECT_TRUE(sample_by_area(Mesh{}, 1000, 1).points.empty());
}

}  // namespace
}  // namespace gim

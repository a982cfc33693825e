#include "encoder/surface/stretch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gim {
namespace {

TEST(Stretch, IsometryHasEfficiencyOne) {
    const Mesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, {{0, 1, 2}, {0, 2, 3}}};
    EXPECT_NEAR(stretch_efficiency(mesh, {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)}, 1), 1, 1e-12);
}

TEST(Stretch, EqualsHalfTheSumOfSquaredSingularValues) {
    // The map (s, t) -> (2 s, 3 t): singular values 2 and 3.
    const FaceMetric metric = face_metric(Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 3, 0), 0);
    const double area = 3;
    EXPECT_NEAR(stretch_energy(metric, Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)), area * (4 + 9) / 2, 1e-12);
}

TEST(Stretch, FlatAndTurnedTrianglesAreInfinite) {
    const FaceMetric metric = face_metric(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), 0);
    EXPECT_TRUE(std::isinf(stretch_energy(metric, Vec2(0, 0), Vec2(0, 1), Vec2(1, 0))));
    EXPECT_TRUE(std::isinf(stretch_energy(metric, Vec2(0, 0), Vec2(1, 0), Vec2(2, 0))));
}

// A square fan around a vertex over the flat unit square with its centre at (0.5, 0.5).
std::vector<StarTriangle> square_star() {
    const Vec2 corners[4] = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
    std::vector<StarTriangle> star;
    for (int i = 0; i < 4; ++i) star.push_back({corners[i], corners[(i + 1) % 4], {1.0, 0.5, 0.5}, 0.125});
    return star;
}

TEST(MinimiseStar, FindsTheIsometricPlaceFromNearTheRim) {
    Vec2 x(0.01, 0.9);
    const std::vector<StarTriangle> star = square_star();
    const double energy = minimise_star(star, x, 50);
    EXPECT_NEAR(x.x(), 0.5, 1e-4);
    EXPECT_NEAR(x.y(), 0.5, 1e-4);
    EXPECT_NEAR(energy, 1, 1e-6);
}

TEST(MinimiseStar, NeverLeavesTheKernel) {
    const std::vector<StarTriangle> star = square_star();
    for (int i = 1; i < 40; ++i) {
        Vec2 x(i / 40.0, 1e-7);
        minimise_star(star, x, 1);
        for (const StarTriangle& t : star) EXPECT_GT(twice_signed_area(x, t.p1, t.p2), 0);
    }
}

TEST(KernelPoint, IsSeenByEveryTriangleOfAConcaveStar) {
    // An arrow head: the kernel is the small part near the tip.
    const Vec2 corners[4] = {Vec2(0, 0), Vec2(1, 0.4), Vec2(0, 2), Vec2(0.3, 0.4)};
    std::vector<StarTriangle> star;
    for (int i = 0; i < 4; ++i) star.push_back({corners[i], corners[(i + 1) % 4], {1, 1, 1}, 1});
    Vec2 x;
    ASSERT_TRUE(find_kernel_point(star, x));
    for (const StarTriangle& t : star) EXPECT_GT(twice_signed_area(x, t.p1, t.p2), 0);
}

TEST(KernelPoint, EmptyKernelIsReported) {
    // Two half-planes that face away from each other.
    const std::vector<StarTriangle> star{{Vec2(0, 0), Vec2(1, 0), {1, 1, 1}, 1},
                                         {Vec2(1, -1), Vec2(0, -1), {1, 1, 1}, 1}};
    Vec2 x;
    EXPECT_FALSE(find_kernel_point(star, x));
}

}  // namespace
}  // namespace gim

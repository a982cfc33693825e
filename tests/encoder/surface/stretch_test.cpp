#include "encoder/surface/stretch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

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

// A triangle on the surface and its upright place in the map.
struct MappedTriangle {
    std::array<Vec3, 3> q;
    std::array<Vec2, 3> p;

    // Squares of the singular values of the map: the eigenvalues of its metric.
    Vec2 squared_singular_values() const {
        Eigen::Matrix<double, 3, 2> on_surface;
        on_surface << q[1] - q[0], q[2] - q[0];
        Eigen::Matrix2d in_map;
        in_map << p[1] - p[0], p[2] - p[0];
        const Eigen::Matrix<double, 3, 2> map = on_surface * in_map.inverse();
        const Eigen::Matrix2d metric = map.transpose() * map;
        const double mean = 0.5 * metric.trace(),
                     radius = std::hypot(0.5 * (metric(0, 0) - metric(1, 1)), metric(0, 1));
        return Vec2(mean + radius, mean - radius);
    }
    double area() const { return 0.5 * (q[1] - q[0]).cross(q[2] - q[0]).norm(); }
};

class RandomPoints {
  public:
    double number() { return between_(engine_); }
    Vec2 in_plane() { return Vec2(number(), number()); }
    Vec3 in_space() { return Vec3(number(), number(), number()); }
    MappedTriangle triangle() {
        MappedTriangle t{{in_space(), in_space(), in_space()}, {in_plane(), in_plane(), in_plane()}};
        if (twice_signed_area(t.p[0], t.p[1], t.p[2]) < 0) std::swap(t.p[1], t.p[2]);
        return t;
    }

  private:
    std::mt19937 engine_{7};
    std::uniform_real_distribution<double> between_{-1, 1};
};

TEST(Stretch, SqueezeAddsTheSumOfInverseSquaredSingularValues) {
    RandomPoints random;
    for (int round = 0; round < 200; ++round) {
        const MappedTriangle t = random.triangle();
        const double surface = 3 + round, kappa = 0.1 * round, area = t.area();
        FaceMetric metric = face_metric(t.q[0], t.q[1], t.q[2], 0);
        metric.squeeze = kappa * surface * surface / 8 / area;
        const Vec2 squares = t.squared_singular_values();
        const double expected =
            0.5 * area * squares.sum() + 0.5 * area * kappa * surface * surface * squares.cwiseInverse().sum();
        EXPECT_NEAR(stretch_energy(metric, t.p[0], t.p[1], t.p[2]) / expected, 1, 1e-6) << round;
        EXPECT_TRUE(std::isinf(stretch_energy(metric, t.p[0], t.p[2], t.p[1])));
    }
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

// A fan around a hill whose star in the map has no symmetry.
std::vector<StarTriangle> crooked_star(RandomPoints& random, double squeeze) {
    constexpr size_t count = 6;
    std::array<Vec2, count> in_map;
    std::array<Vec3, count> on_surface;
    const Vec3 top(0.1, 0.2, random.number());
    for (size_t i = 0; i < count; ++i) {
        const double angle = (double(i) + 0.3 * random.number()) * 2 * std::numbers::pi / count;
        in_map[i] = (1 + 0.3 * random.number()) * Vec2(std::cos(angle), std::sin(angle));
        // The surface is much longer in one direction.
        on_surface[i] = Vec3(8 * in_map[i].x(), in_map[i].y(), random.number());
    }
    std::vector<StarTriangle> star;
    for (size_t i = 0; i < count; ++i) {
        const size_t next = (i + 1) % count;
        const FaceMetric metric = face_metric(top, on_surface[i], on_surface[next], 0);
        star.push_back({in_map[i], in_map[next], metric.squared_length, metric.weight, squeeze / metric.weight});
    }
    return star;
}

double energy_at(const std::vector<StarTriangle>& star, const Vec2& x) {
    double energy = 0;
    for (const StarTriangle& t : star) energy += stretch_energy({t.squared_length, t.weight, t.squeeze}, x, t.p1, t.p2);
    return energy;
}

TEST(MinimiseStar, SqueezedStarsEndAtALowerEnergyWithoutAGradient) {
    RandomPoints random;
    for (int round = 0; round < 50; ++round) {
        const std::vector<StarTriangle> star = crooked_star(random, 0.5 * round);
        const Vec2 start(0.3 * random.number(), 0.3 * random.number());
        Vec2 x = start;
        double energy = minimise_star(star, x, 1);
        EXPECT_LT(energy, energy_at(star, start)) << round;
        EXPECT_NEAR(energy, energy_at(star, x), 1e-9 * energy) << round;
        // A call ends when a step gains next to nothing. Some more go to the minimum itself.
        for (int again = 0; again < 10; ++again) energy = minimise_star(star, x, 50);
        EXPECT_NEAR(energy, energy_at(star, x), 1e-9 * energy) << round;
        constexpr double h = 1e-4;
        for (const Vec2& direction : {Vec2(1, 0), Vec2(0, 1), Vec2(0.6, 0.8)}) {
            const double ahead = energy_at(star, x + h * direction), behind = energy_at(star, x - h * direction);
            const double curvature = (ahead + behind - 2 * energy) / (h * h);
            EXPECT_LT(std::abs(ahead - behind) / (2 * h), 1e-4 * curvature) << round;
        }
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

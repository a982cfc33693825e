#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "corpus/generators.h"
#include "gim/encoder.h"
#include "tests/models.h"

namespace gim {
namespace {

TriangleMesh shifted(TriangleMesh mesh, double x, double y, double z) {
    for (auto& p : mesh.positions) p = {p[0] + x, p[1] + y, p[2] + z};
    return mesh;
}

// A flat square of n x n cells.
TriangleMesh square(uint32_t n) {
    TriangleMesh mesh = corpus::terrain(n);
    for (auto& p : mesh.positions) p[2] = 0;
    return mesh;
}

TEST(Compare, ParallelSquaresAreAsFarApartAsTheyAre) {
    const auto result = compare(square(7), shifted(square(3), 0, 0, 0.25), {});
    ASSERT_TRUE(result.ok()) << result.error().message;
    const Comparison& c = result.value();
    EXPECT_NEAR(c.rms_to_test, 0.25, 1e-12);
    EXPECT_NEAR(c.rms_to_reference, 0.25, 1e-12);
    EXPECT_NEAR(c.hausdorff, 0.25, 1e-12);
    EXPECT_NEAR(c.diagonal, std::sqrt(8.0), 1e-12);
    EXPECT_NEAR(c.psnr, 20 * std::log10(std::sqrt(8.0) / 0.25), 1e-9);
}

TEST(Compare, TiltedSquareHasTheRmsOfItsHeights) {
    // Heights h(x) = x/10 over [-1, 1]: distance to the plane is |h|, its mean square over the tilted area 1/300.
    TriangleMesh tilted = square(4);
    for (auto& p : tilted.positions) p[2] = p[0] / 10;
    TriangleMesh ground = square(2);
    for (auto& p : ground.positions) p = {2 * p[0], 2 * p[1], 0};
    const auto result = compare(tilted, ground, {});
    ASSERT_TRUE(result.ok());
    EXPECT_NEAR(result.value().rms_to_test, std::sqrt(1.0 / 300), 2e-6);
    EXPECT_NEAR(result.value().max_to_test, 0.1, 1e-12);  // at the corners: vertices are tried
}

TEST(Compare, PartOfASurfaceIsNearTheWholeButNotTheOtherWayRound) {
    // The left half of a square against all of it: distances x of the right half, mean square (1/2) * (1/3).
    TriangleMesh half = square(2);
    for (auto& p : half.positions) p[0] = 0.5 * p[0] - 0.5;
    const auto result = compare(square(2), half, {});
    ASSERT_TRUE(result.ok());
    EXPECT_NEAR(result.value().rms_to_reference, 0, 1e-12);
    EXPECT_NEAR(result.value().rms_to_test, std::sqrt(1.0 / 6), 1e-4);
    EXPECT_EQ(result.value().rms, result.value().rms_to_test);
}

TEST(Compare, ConcentricSpheresAreTheirRadiiApart) {
    TriangleMesh outer = corpus::sphere(40);
    for (auto& p : outer.positions) p = {1.1 * p[0], 1.1 * p[1], 1.1 * p[2]};
    const auto result = compare(corpus::sphere(40), outer, {});
    ASSERT_TRUE(result.ok());
    EXPECT_NEAR(result.value().rms_to_test, 0.1, 2e-3);
    EXPECT_NEAR(result.value().rms_to_reference, 0.1, 2e-3);
}

TEST(Compare, ThreadsAndRepetitionChangeNothing) {
    const TriangleMesh a = corpus::limbed_blob(24), b = corpus::roughened(a, 0.01, 1);
    CompareOptions options;
    options.samples = 40000;
    options.threads = 1;
    const auto one = compare(a, b, options);
    options.threads = 2;
    const auto two = compare(a, b, options);
    ASSERT_TRUE(one.ok() && two.ok());
    EXPECT_EQ(one.value().rms_to_test, two.value().rms_to_test);
    EXPECT_EQ(one.value().rms_to_reference, two.value().rms_to_reference);
    EXPECT_EQ(one.value().hausdorff, two.value().hausdorff);
}

TEST(Compare, UnusableMeshesAreRefusedByName) {
    const TriangleMesh good = corpus::sphere(3);
    TriangleMesh missing = good, not_finite = good;
    missing.triangles[4][1] = 999;
    not_finite.positions[2][0] = std::numeric_limits<double>::infinity();
    const TriangleMesh flat{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
    for (const TriangleMesh& bad : {TriangleMesh{}, missing, not_finite, flat}) {
        const auto as_test = compare(good, bad, {}), as_reference = compare(bad, good, {});
        ASSERT_FALSE(as_test.ok());
        ASSERT_FALSE(as_reference.ok());
        EXPECT_EQ(as_test.error().stage, Stage::kCompare);
        EXPECT_NE(as_test.error().message.find("test"), std::string::npos);
        EXPECT_NE(as_reference.error().message.find("reference"), std::string::npos);
    }
}

TEST(Compare, AuthorsImageOfTheBunnyHasItsKnownDistance) {
    auto bunny = load_model("bunny.ply");
    const auto image = load_model("../authors-gim/bunny-gim-closed.ply");
    if (!bunny || !image) GTEST_SKIP() << "no development models in " << GIM_MODELS_DIR;
    const double scale = 3.545609, shift[3] = {0.335758, 0.335798, 0.335768};
    for (auto& p : bunny->positions) {
        for (int k = 0; k < 3; ++k) p[k] = scale * p[k] + shift[k];
    }
    const auto result = compare(*bunny, *image, {});
    ASSERT_TRUE(result.ok());
    EXPECT_NEAR(20 * std::log10(result.value().diagonal / result.value().rms_to_test), 78.8, 0.1);
    EXPECT_NEAR(result.value().max_to_test / result.value().diagonal, 3.4e-3, 2e-4);
}

}  // namespace
}  // namespace gim

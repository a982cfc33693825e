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

TEST(Compare, SizesWhoseSquaresLeaveTheRangeOfDoublesAreMeasured) {
    const TriangleMesh a = corpus::sphere(8), b = shifted(a, 0.01, 0.02, 0.03);
    const auto scaled = [](TriangleMesh mesh, int exponent) {
        for (auto& p : mesh.positions) {
            for (double& x : p) x = std::ldexp(x, exponent);
        }
        return mesh;
    };
    CompareOptions options;
    options.samples = 5000;
    options.normals = options.defects = true;
    const auto plain = compare(a, b, options);
    ASSERT_TRUE(plain.ok());
    for (const int exponent : {-1000, -700, -120, 120, 700, 1000}) {
        const auto extreme = compare(scaled(a, exponent), scaled(b, exponent), options);
        ASSERT_TRUE(extreme.ok()) << exponent << extreme.error().message;
        EXPECT_NEAR(extreme.value().psnr, plain.value().psnr, 1e-9) << exponent;
        EXPECT_NEAR(std::ldexp(extreme.value().rms, -exponent), plain.value().rms, 1e-12) << exponent;
        EXPECT_NEAR(std::ldexp(extreme.value().hausdorff, -exponent), plain.value().hausdorff, 1e-12) << exponent;
        EXPECT_NEAR(std::ldexp(extreme.value().diagonal, -exponent), plain.value().diagonal, 1e-12) << exponent;
        EXPECT_NEAR(extreme.value().normals->mean, plain.value().normals->mean, 1e-9) << exponent;
        EXPECT_EQ(extreme.value().defects->folded_faces, plain.value().defects->folded_faces) << exponent;
        EXPECT_TRUE(map_defects(scaled(a, exponent), scaled(b, exponent)).ok());
    }
    // Beside a surface of 2^1000 the other one is a point.
    for (const auto& far_apart : {compare(scaled(a, 1000), b, options), compare(b, scaled(a, 1000), options)}) {
        ASSERT_FALSE(far_apart.ok());
        EXPECT_NE(far_apart.error().message.find("no area"), std::string::npos) << far_apart.error().message;
    }
}

TEST(Compare, FarFromZeroSurfacesAreMeasuredAsNearIt) {
    // Coordinates that are whole multiples of 2^-8 are exact at 2^40.
    TriangleMesh a = corpus::sphere(12);
    for (auto& p : a.positions) {
        for (double& x : p) x = std::floor(x * 256) / 256;
    }
    TriangleMesh b = a;
    std::swap(b.triangles[5][1], b.triangles[5][2]);  // a fold, which has a place
    b.positions[3][0] += 1.0 / 256;
    CompareOptions options;
    options.samples = 5000;
    options.defects = true;
    const auto near = compare(a, b, options),
               far = compare(shifted(a, 0x1p40, -0x1p41, 0), shifted(b, 0x1p40, -0x1p41, 0), options);
    ASSERT_TRUE(near.ok() && far.ok());
    EXPECT_NEAR(far.value().psnr, near.value().psnr, 1e-6);
    const auto &near_fold = near.value().defects->largest_fold, &far_fold = far.value().defects->largest_fold;
    ASSERT_EQ(near_fold.faces, far_fold.faces);
    ASSERT_GT(near_fold.faces, 0u);
    EXPECT_NEAR(far_fold.center[0] - 0x1p40, near_fold.center[0], 1e-3);
    EXPECT_NEAR(far_fold.center[1] + 0x1p41, near_fold.center[1], 1e-3);
}

// Ground of area 4 with an upright fin of area 2 and height 1: 2/6 of the area has mean square height 1/3.
TEST(Compare, AFinCountsWhicheverSurfaceHasIt) {
    const TriangleMesh ground = square(6);
    TriangleMesh with_fin = ground;
    const auto first = static_cast<uint32_t>(with_fin.positions.size());
    with_fin.positions.insert(with_fin.positions.end(), {{-1, 0, 0}, {1, 0, 0}, {1, 0, 1}, {-1, 0, 1}});
    with_fin.triangles.push_back({first, first + 1, first + 2});
    with_fin.triangles.push_back({first, first + 2, first + 3});
    const auto lost = compare(with_fin, ground, {}), grown = compare(ground, with_fin, {});
    ASSERT_TRUE(lost.ok() && grown.ok());
    EXPECT_NEAR(lost.value().rms_to_reference, 0, 1e-12);
    EXPECT_NEAR(lost.value().rms_to_test, 1.0 / 3, 1e-4);
    EXPECT_NEAR(grown.value().rms_to_test, 0, 1e-12);
    EXPECT_NEAR(grown.value().rms_to_reference, 1.0 / 3, 1e-4);
    for (const Comparison& c : {lost.value(), grown.value()}) {
        EXPECT_NEAR(c.rms, 1.0 / 3, 1e-4);
        EXPECT_NEAR(c.hausdorff, 1, 1e-12);
        EXPECT_NEAR(c.psnr, 20 * std::log10(3 * c.diagonal), 5e-3);
    }
    EXPECT_NEAR(lost.value().diagonal, 3, 1e-12);  // the reference's: 2 x 2 x 1
    EXPECT_NEAR(grown.value().diagonal, std::sqrt(8.0), 1e-12);
}

TEST(Compare, ConcentricSpheresAreTheirRadiiApart) {
    TriangleMesh outer = corpus::sphere(40);
    for (auto& p : outer.positions) p = {1.1 * p[0], 1.1 * p[1], 1.1 * p[2]};
    const auto result = compare(corpus::sphere(40), outer, {});
    ASSERT_TRUE(result.ok());
    EXPECT_NEAR(result.value().rms_to_test, 0.1, 2e-3);
    EXPECT_NEAR(result.value().rms_to_reference, 0.1, 2e-3);
}

TEST(Compare, WhereTheNumberOfSamplesIsLeftOpenFacesDecide) {
    const auto rms = [](const TriangleMesh& a, const TriangleMesh& b, uint32_t samples) {
        CompareOptions options;
        options.samples = samples;
        const auto result = compare(a, b, options);
        EXPECT_TRUE(result.ok());
        return result.ok() ? result.value().rms_to_test : 0;
    };
    const TriangleMesh small = corpus::sphere(8), near_small = corpus::roughened(small, 0.01, 1);
    EXPECT_EQ(rms(small, near_small, 0), rms(small, near_small, 100000));
    const TriangleMesh middle = corpus::sphere(64), near_middle = corpus::roughened(middle, 0.01, 1);
    const auto faces = static_cast<uint32_t>(middle.triangles.size() + near_middle.triangles.size());
    ASSERT_GT(4 * faces, 100000u);
    ASSERT_LT(4 * faces, 500000u);
    EXPECT_EQ(rms(middle, near_middle, 0), rms(middle, near_middle, 4 * faces));
    EXPECT_NEAR(rms(middle, near_middle, 0), rms(middle, near_middle, 500000), 0.01 * rms(middle, near_middle, 500000));
}

TEST(Compare, ThreadsAndRepetitionChangeNothing) {
    const TriangleMesh a = corpus::limbed_blob(24), b = corpus::roughened(a, 0.01, 1);
    CompareOptions options;
    options.samples = 40000;
    options.normals = true;
    options.threads = 1;
    const auto one = compare(a, b, options);
    options.threads = 2;
    const auto two = compare(a, b, options);
    ASSERT_TRUE(one.ok() && two.ok());
    EXPECT_EQ(one.value().rms_to_test, two.value().rms_to_test);
    EXPECT_EQ(one.value().rms_to_reference, two.value().rms_to_reference);
    EXPECT_EQ(one.value().hausdorff, two.value().hausdorff);
    EXPECT_EQ(one.value().normals->to_test, two.value().normals->to_test);
    EXPECT_EQ(one.value().normals->to_reference, two.value().normals->to_reference);
}

CompareOptions with_normals() {
    CompareOptions options;
    options.samples = 50000;
    options.normals = true;
    return options;
}

NormalError normal_error(const TriangleMesh& reference, const TriangleMesh& test) {
    const auto result = compare(reference, test, with_normals());
    if (!result.ok() || !result.value().normals) return {.to_test = -1, .to_reference = -1, .mean = -1};
    return *result.value().normals;
}

TEST(Compare, NormalsAreMeasuredOnlyWhereAskedFor) {
    const TriangleMesh mesh = corpus::sphere(6);
    const auto plain = compare(mesh, mesh, {}), asked = compare(mesh, mesh, with_normals());
    ASSERT_TRUE(plain.ok() && asked.ok());
    EXPECT_FALSE(plain.value().normals.has_value());
    EXPECT_TRUE(asked.value().normals.has_value());
}

TEST(Compare, NormalsOfEqualSurfacesAgreeHoweverTheirVerticesAreShared) {
    const TriangleMesh mesh = corpus::limbed_blob(20);
    for (const TriangleMesh& other : {mesh, corpus::soup(mesh)}) {
        const NormalError error = normal_error(mesh, other);
        EXPECT_GE(error.mean, 0);
        EXPECT_LT(error.to_test, 1e-4);
        EXPECT_LT(error.to_reference, 1e-4);
    }
}

TEST(Compare, NormalsOfATurnedSurfaceAreOpposite) {
    const TriangleMesh mesh = corpus::sphere(12);
    TriangleMesh turned = mesh;
    for (auto& t : turned.triangles) std::swap(t[0], t[1]);
    const NormalError error = normal_error(mesh, turned);
    EXPECT_NEAR(error.to_test, 180, 1e-4);
    EXPECT_NEAR(error.to_reference, 180, 1e-4);
}

TEST(Compare, NormalsOfTwoPlanesDifferByTheirAngle) {
    TriangleMesh tilted = square(4);
    for (auto& p : tilted.positions) p[2] = p[0] / 10;
    const NormalError error = normal_error(square(7), tilted);
    const double angle = std::atan(0.1) * 180 / 3.14159265358979323846;
    EXPECT_NEAR(error.to_test, angle, 1e-6);
    EXPECT_NEAR(error.to_reference, angle, 1e-6);
    EXPECT_NEAR(error.mean, angle, 1e-6);
}

TEST(Compare, NormalsOfOneWayAreTheMeanOverItsOwnArea) {
    // A roof of 45 degrees over the left half of the ground, flat ground on the right. The angle is 45 degrees on
    // sqrt(2) of 1 + sqrt(2) of its area. The ridge shares no vertices, so its normals do not blend.
    const TriangleMesh roof{{{-1, 0, 0}, {0, 0, 1}, {0, 2, 1}, {-1, 2, 0}, {0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}},
                            {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}};
    const TriangleMesh ground{{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    const auto result = compare(ground, roof, with_normals());
    ASSERT_TRUE(result.ok());
    EXPECT_NEAR(result.value().normals->to_reference, 45 * std::sqrt(2.0) / (1 + std::sqrt(2.0)), 0.01);
}

TEST(Compare, NormalsOfARefinedSphereAreNear) {
    const double coarse = normal_error(corpus::sphere(40), corpus::sphere(8)).mean;
    const double fine = normal_error(corpus::sphere(40), corpus::sphere(20)).mean;
    EXPECT_LT(coarse, 2);
    EXPECT_LT(fine, 0.5);
    EXPECT_LT(fine, coarse);
    EXPECT_GT(fine, 0);
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

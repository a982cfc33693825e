// What encode() reports and promises, seen from outside: options have their effect, figures agree.
#include <gtest/gtest.h>

#include <cmath>

#include "corpus/generators.h"
#include "gim/encoder.h"

namespace gim {
namespace {

EncodeOptions plain_squares() {
    EncodeOptions options;
    options.side = 33;
    options.rate.kind = RateTarget::Kind::kLossless;
    options.fit = FitStrength::kOff;
    options.density = false;
    return options;
}

Encoded encoded(const TriangleMesh& mesh, const EncodeOptions& options) {
    auto result = encode(mesh, options);
    EXPECT_TRUE(result.ok()) << result.error().message;
    return result.ok() ? std::move(result.value()) : Encoded{};
}

// A sheet with waves in one corner and nothing but slope in the others.
TriangleMesh wavy_corner() {
    TriangleMesh mesh = corpus::terrain(40);
    for (auto& p : mesh.positions)
        p[2] = 0.05 * std::max(0.0, p[0] + p[1] - 0.4) * std::sin(16 * p[0]) * std::sin(16 * p[1]);
    return mesh;
}

TEST(Report, SamplesGoWhereTheyAreNeeded) {
    EncodeOptions options = plain_squares();
    const double even = encoded(wavy_corner(), options).report.error.psnr;
    options.density = true;
    EXPECT_GT(encoded(wavy_corner(), options).report.error.psnr, even + 1);
}

TEST(Report, EfficiencyOfTwoEqualPartsIsThatOfOne) {
    const TriangleMesh part = corpus::sphere(8);
    const double one = encoded(part, plain_squares()).report.stretch_efficiency;
    const double two = encoded(corpus::together({part, part}, 3), plain_squares()).report.stretch_efficiency;
    EXPECT_GT(one, 0);
    EXPECT_LE(one, 1);
    EXPECT_NEAR(two, one, 0.05);
}

TEST(Report, PlaneQualityIsItsOwnAndElseThatOfTheSamples) {
    EncodeOptions options = plain_squares();
    options.rate = {RateTarget::Kind::kQuality, 60};
    options.normal_side = 65;
    const TriangleMesh mesh = corpus::roughened(corpus::sphere(12), 0.02, 1);
    const auto plane = [&](std::optional<double> quality) {
        options.plane_quality = quality;
        return encoded(mesh, options).report.planes.at(0);
    };
    const PlaneReport usual = plane({}), same = plane(60), finer = plane(90);
    EXPECT_EQ(usual.bytes, same.bytes);
    EXPECT_GT(finer.bytes, same.bytes);
    EXPECT_LT(finer.mean_angle, same.mean_angle);
}

}  // namespace
}  // namespace gim

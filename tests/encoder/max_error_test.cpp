// Files whose largest distance from the input is bounded: RateTarget::Kind::kMaxError.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "corpus/corpus.h"
#include "encoder/code/decode_surface.h"
#include "gim/encoder.h"

namespace gim {
namespace {

EncodeOptions options_of(const RateTarget& rate, FitStrength fit) {
    EncodeOptions options;
    options.side = 33;
    options.rate = rate;
    options.fit = fit;
    return options;
}

RateTarget of_diagonal(double share) { return {RateTarget::Kind::kMaxError, share, true}; }
RateTarget of_units(double length) { return {RateTarget::Kind::kMaxError, length}; }

TriangleMesh bumpy_sphere() { return corpus::roughened(corpus::sphere(20), 0.01, 4); }
TriangleMesh torus() { return corpus::torus(60, 30, 1, 0.4); }

// Measures as a user would.
Comparison measured(const TriangleMesh& mesh, const Encoded& encoded) {
    const Mesh decoded = decode_surface(encoded.bytes, 0).value();
    TriangleMesh test;
    for (const Vec3& p : decoded.positions) test.positions.push_back({p.x(), p.y(), p.z()});
    test.triangles = decoded.triangles;
    return compare(mesh, test, {}).value();
}

TEST(MaxError, FilesObeyItAndGrowWithIt) {
    for (const FitStrength fit : {FitStrength::kAuto, FitStrength::kStiff}) {
        const TriangleMesh mesh = bumpy_sphere();
        double finer_bytes = 1e9;
        for (const double share : {0.01, 0.02}) {
            const auto encoded = encode(mesh, options_of(of_diagonal(share), fit));
            ASSERT_TRUE(encoded.ok()) << encoded.error().message;
            const Comparison comparison = measured(mesh, encoded.value());
            EXPECT_LE(comparison.hausdorff, share * comparison.diagonal);
            EXPECT_DOUBLE_EQ(comparison.hausdorff, encoded.value().report.error.hausdorff);
            const size_t bytes = encoded.value().bytes.size();
            EXPECT_LE(static_cast<double>(bytes), 1.05 * finer_bytes);
            finer_bytes = static_cast<double>(bytes);
        }
    }
}

TEST(MaxError, UnitsAndSharesOfTheDiagonalAgree) {
    const TriangleMesh mesh = torus();
    const double diagonal = compare(mesh, mesh, {}).value().diagonal;
    const auto share = encode(mesh, options_of(of_diagonal(0.01), FitStrength::kOff));
    const auto length = encode(mesh, options_of(of_units(0.01 * diagonal), FitStrength::kOff));
    ASSERT_TRUE(share.ok() && length.ok());
    EXPECT_EQ(share.value().bytes, length.value().bytes);
    EXPECT_LE(length.value().report.error.hausdorff, 0.01 * diagonal);
}

TEST(MaxError, ChartsObeyItToo) {
    EncodeOptions options = options_of(of_diagonal(0.015), FitStrength::kAuto);
    options.layout = Layout::kMcgim;
    options.samples = 2500;
    options.charts = 6;
    const TriangleMesh mesh = torus();
    const auto encoded = encode(mesh, options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    const Comparison comparison = measured(mesh, encoded.value());
    EXPECT_LE(comparison.hausdorff, 0.015 * comparison.diagonal);
    EXPECT_GE(comparison.hausdorff, 0.01 * comparison.diagonal);
}

TEST(MaxError, ImportedImagesObeyIt) {
    std::vector<float> channels;
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < 33 * 33; ++i) {
            const int row = i / 33, column = i % 33;
            const double height = 3 * std::sin(0.4 * row) * std::cos(0.3 * column);
            channels.push_back(static_cast<float>(axis == 0 ? column : axis == 1 ? row : height));
        }
    }
    const auto encoded = encode_image(channels, 33, 1e-6, options_of(of_units(0.25), FitStrength::kAuto));
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_LE(encoded.value().report.error.hausdorff, 0.25);
}

TEST(MaxError, OutOfReachIsAnErrorThatNamesWhatIsInReach) {
    const TriangleMesh mesh = torus();
    for (const FitStrength fit : {FitStrength::kOff, FitStrength::kAuto}) {
        EncodeOptions options = options_of(of_units(1e-5), fit);
        options.side = 17;
        const auto encoded = encode(mesh, options);
        ASSERT_FALSE(encoded.ok());
        const std::string& message = encoded.error().message;
        EXPECT_EQ(encoded.error().stage, Stage::kCode);
        EXPECT_NE(message.find("a largest error of 1e-05 ("), std::string::npos) << message;
        const std::string before = "the samples themselves reach ";
        const size_t place = message.find(before);
        ASSERT_NE(place, std::string::npos) << message;
        const double reached = std::strtod(message.c_str() + place + before.size(), nullptr);
        ASSERT_GT(reached, 1e-5) << message;
        if (fit != FitStrength::kOff) continue;  // fits of another search end elsewhere
        options.rate = of_units(reached);
        const auto again = encode(mesh, options);
        ASSERT_TRUE(again.ok()) << message << "\n" << again.error().message;
        EXPECT_LE(again.value().report.error.hausdorff, reached);
    }
}

TEST(MaxError, SmallerSidesAreTriedWhereTheTargetIsCoarse) {
    EncodeOptions options = options_of(of_diagonal(0.03), FitStrength::kStiff);
    options.side = 65;
    const TriangleMesh mesh = bumpy_sphere();
    const auto full = encode(mesh, options);
    options.try_smaller_sides = true;
    const auto best = encode(mesh, options);
    ASSERT_TRUE(full.ok() && best.ok());
    EXPECT_EQ(best.value().report.side, 33u);
    EXPECT_LT(best.value().bytes.size(), full.value().bytes.size());
    EXPECT_LE(best.value().report.error.hausdorff, 0.03 * best.value().report.error.diagonal);
}

TEST(MaxError, HugeOnesGiveTheSmallestFile) {
    EncodeOptions options = options_of(of_units(1e300), FitStrength::kOff);
    options.side = 9;
    options.node_side = 5;
    EXPECT_TRUE(encode(corpus::sphere(4), options).ok());
}

TEST(MaxError, ValuesThatAreNoLengthsAreRefused) {
    for (const double value : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        const auto encoded = encode(torus(), options_of(of_units(value), FitStrength::kOff));
        ASSERT_FALSE(encoded.ok()) << value;
        EXPECT_EQ(encoded.error().stage, Stage::kInput) << value;
    }
}

}  // namespace
}  // namespace gim

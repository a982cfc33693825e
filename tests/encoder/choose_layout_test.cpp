// Layout::kAuto: which layout it chooses.
#include <gtest/gtest.h>

#include <cmath>

#include "corpus/generators.h"
#include "gim/encoder.h"

namespace gim {
namespace {

Encoded encoded_as(Layout layout, const TriangleMesh& mesh, const RateTarget& rate) {
    EncodeOptions options;
    options.layout = layout;
    options.side = 33;
    options.samples = 33 * 33;
    options.rate = rate;
    options.fit = FitStrength::kOff;
    options.density = false;
    auto encoded = encode(mesh, options);
    EXPECT_TRUE(encoded.ok()) << encoded.error().message;
    return encoded.ok() ? std::move(encoded.value()) : Encoded{};
}

struct Choice {
    Encoded squares, charts, automatic;

    Choice(const TriangleMesh& mesh, const RateTarget& rate)
        : squares(encoded_as(Layout::kGim, mesh, rate)),
          charts(encoded_as(Layout::kMcgim, mesh, rate)),
          automatic(encoded_as(Layout::kAuto, mesh, rate)) {}

    // By how many decibels charts are nearer to the mesh at the same number of samples.
    double gain_of_charts() const { return charts.report.error.psnr - squares.report.error.psnr; }
};

constexpr RateTarget kLossless{RateTarget::Kind::kLossless, 0};

TEST(ChooseLayout, ASheetOverASquareStaysASquare) {
    const Choice choice(corpus::terrain(12), kLossless);
    ASSERT_LT(choice.gain_of_charts(), 0);
    EXPECT_EQ(choice.automatic.report.layout, Layout::kGim);
    EXPECT_EQ(choice.automatic.bytes, choice.squares.bytes);
}

TEST(ChooseLayout, ABoxIsCutIntoItsFaces) {
    const Choice choice(corpus::box(4, 0.6, 0.3), kLossless);
    ASSERT_GT(choice.gain_of_charts(), 3);
    EXPECT_EQ(choice.automatic.report.layout, Layout::kMcgim);
    EXPECT_EQ(choice.automatic.bytes, choice.charts.bytes);
}

}  // namespace
}  // namespace gim

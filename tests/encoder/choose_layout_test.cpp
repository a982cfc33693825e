// Layout::kAuto: which layout it chooses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "corpus/generators.h"
#include "gim/encoder.h"

namespace gim {
namespace {

Result<Encoded> encoded_as(Layout layout, const TriangleMesh& mesh, const RateTarget& rate, uint32_t side,
                           FitStrength fit) {
    EncodeOptions options;
    options.layout = layout;
    options.side = side;
    options.samples = side * side;
    options.rate = rate;
    options.fit = fit;
    options.density = false;
    return encode(mesh, options);
}

// ---- lossless files -------------------------------------------------------------------------------------------------

Encoded sampled_as(Layout layout, const TriangleMesh& mesh, const RateTarget& rate) {
    auto encoded = encoded_as(layout, mesh, rate, 33, FitStrength::kOff);
    EXPECT_TRUE(encoded.ok()) << encoded.error().message;
    return encoded.ok() ? std::move(encoded.value()) : Encoded{};
}

struct Choice {
    Encoded squares, charts, automatic;

    Choice(const TriangleMesh& mesh, const RateTarget& rate)
        : squares(sampled_as(Layout::kGim, mesh, rate)),
          charts(sampled_as(Layout::kMcgim, mesh, rate)),
          automatic(sampled_as(Layout::kAuto, mesh, rate)) {}

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

// ---- lossy files: squares and tiles race ----------------------------------------------------------------------------

Result<Encoded> raced(Layout layout, const TriangleMesh& mesh, const RateTarget& rate) {
    return encoded_as(layout, mesh, rate, 65, FitStrength::kStiff);
}

TEST(ChooseLayout, OfSquaresAndTilesTheSmallerFileIsKept) {
    constexpr RateTarget kPsnr{RateTarget::Kind::kPsnr, 45};
    size_t wins_of_tiles = 0;
    const TriangleMesh meshes[] = {corpus::terrain(24), corpus::limbed_blob(24)};
    for (const TriangleMesh& mesh : meshes) {
        const auto squares = raced(Layout::kGim, mesh, kPsnr), tiles = raced(Layout::kTiles, mesh, kPsnr);
        const auto best = raced(Layout::kAuto, mesh, kPsnr);
        ASSERT_TRUE(squares.ok() && tiles.ok() && best.ok());
        const bool has_tiles = best.value().report.layout == Layout::kTiles;
        EXPECT_EQ(best.value().bytes, has_tiles ? tiles.value().bytes : squares.value().bytes);
        const size_t smaller = std::min(squares.value().bytes.size(), tiles.value().bytes.size());
        EXPECT_LE(double(best.value().bytes.size()), 1.02 * double(smaller));
        wins_of_tiles += has_tiles;
    }
    EXPECT_GT(wins_of_tiles, 0);
    EXPECT_LT(wins_of_tiles, std::size(meshes));
}

// What the square reaches at a quality is about what the other layouts must reach. A square that wins is the file that it
// is alone.
TEST(ChooseLayout, AtAQualityTheWinnerReachesAboutThePsnrOfTheSquare) {
    constexpr RateTarget kQuality{RateTarget::Kind::kQuality, 60};
    constexpr double kAbout = 0.5;  // dB
    size_t wins_of_squares = 0;
    const TriangleMesh meshes[] = {corpus::terrain(24), corpus::limbed_blob(24)};
    for (const TriangleMesh& mesh : meshes) {
        const auto square = raced(Layout::kGim, mesh, kQuality), best = raced(Layout::kAuto, mesh, kQuality);
        ASSERT_TRUE(square.ok() && best.ok());
        if (best.value().report.layout == Layout::kGim) {
            ++wins_of_squares;
            EXPECT_EQ(best.value().bytes, square.value().bytes);
            continue;
        }
        EXPECT_NEAR(best.value().report.error.psnr, square.value().report.error.psnr, kAbout);
        EXPECT_LT(best.value().bytes.size(), square.value().bytes.size());
    }
    EXPECT_GT(wins_of_squares, 0);
    EXPECT_LT(wins_of_squares, std::size(meshes));
}

TEST(ChooseLayout, ColoursAreKeptWhateverWins) {
    TriangleMesh mesh = corpus::plate_with_holes(2, 4);
    mesh.appearance.corner_colors.assign(mesh.triangles.size(), {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
    const auto best = raced(Layout::kAuto, mesh, {RateTarget::Kind::kPsnr, 45});
    ASSERT_TRUE(best.ok());
    EXPECT_EQ(best.value().report.planes.size(), 1);
    EXPECT_EQ(best.value().report.others.size(), 1);
    EXPECT_TRUE(best.value().report.warnings.empty());
}

}  // namespace
}  // namespace gim

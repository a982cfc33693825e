// EncodeOptions::effort: how long files are worked on.
#include "encoder/fit/effort.h"

#include <gtest/gtest.h>

#include "corpus/generators.h"

namespace gim {
namespace {

TriangleMesh bumpy_torus() { return corpus::roughened(corpus::torus(60, 30, 0.7, 0.3), 0.01, 4); }

EncodeOptions options_of(uint32_t effort, const RateTarget& rate, Layout layout = Layout::kGim) {
    EncodeOptions options;
    options.layout = layout;
    options.side = 65;
    options.samples = 4225;
    options.tiles = 12;
    options.rate = rate;
    options.effort = effort;
    return options;
}

constexpr RateTarget kPsnr{RateTarget::Kind::kPsnr, 50};

TEST(Effort, EveryOneReachesThePsnrThatIsAskedFor) {
    const TriangleMesh mesh = bumpy_torus();
    for (const Layout layout : {Layout::kGim, Layout::kMcgim, Layout::kTiles}) {
        for (const uint32_t effort : {kLeastEffort, 3u, kMostEffort}) {
            const auto encoded = encode(mesh, options_of(effort, kPsnr, layout));
            ASSERT_TRUE(encoded.ok()) << encoded.error().message;
            EXPECT_GE(encoded.value().report.error.psnr, kPsnr.value) << int(layout) << " " << effort;
        }
    }
}

TEST(Effort, MoreOfItTakesFewerBytes) {
    const TriangleMesh mesh = bumpy_torus();
    const auto bytes = [&](uint32_t effort) { return encode(mesh, options_of(effort, kPsnr)).value().bytes.size(); };
    const size_t least = bytes(kLeastEffort), usual = bytes(EncodeOptions{}.effort), most = bytes(kMostEffort);
    EXPECT_LT(double(usual), 0.97 * double(least));
    EXPECT_LE(most, usual);
}

TEST(Effort, BelowTheRaceAutoTakesSquares) {
    const auto encoded = encode(bumpy_torus(), options_of(kLeastEffort, kPsnr, Layout::kAuto));
    ASSERT_TRUE(encoded.ok());
    EXPECT_EQ(encoded.value().report.layout, Layout::kGim);
    EXPECT_TRUE(encoded.value().report.others.empty());
}

TEST(Effort, LosslessFilesAreTheSameWithAny) {
    const TriangleMesh mesh = bumpy_torus();
    const RateTarget lossless{RateTarget::Kind::kLossless, 0};
    const auto least = encode(mesh, options_of(kLeastEffort, lossless)),
               most = encode(mesh, options_of(kMostEffort, lossless));
    EXPECT_EQ(least.value().bytes, most.value().bytes);
}

TEST(Effort, OthersAreRefused) {
    for (const uint32_t effort : {kLeastEffort - 1, kMostEffort + 1}) {
        const auto encoded = encode(bumpy_torus(), options_of(effort, kPsnr));
        ASSERT_FALSE(encoded.ok());
        EXPECT_NE(encoded.error().message.find("effort"), std::string::npos);
    }
}

}  // namespace
}  // namespace gim

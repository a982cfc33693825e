// EncodeOptions::effort: how long files are worked on.
#include "encoder/fit/effort.h"

#include <gtest/gtest.h>

#include "corpus/generators.h"
#include "encoder/code/rate_target.h"

namespace gim {
namespace {

TriangleMesh bumpy_torus() { return corpus::roughened(corpus::torus(60, 30, 0.7, 0.3), 0.01, 4); }

EncodeOptions options_of(uint32_t effort, const RateTarget& rate, Layout layout = Layout::kGim) {
    EncodeOptions options;
    options.layout = layout;
    options.side = 33;
    options.samples = 2200;
    options.tiles = 12;
    options.rate = rate;
    options.effort = effort;
    return options;
}

constexpr RateTarget kPsnr{RateTarget::Kind::kPsnr, 46};

TEST(Effort, EveryOneReachesThePsnrThatIsAskedFor) {
    const TriangleMesh mesh = bumpy_torus();
    for (const Layout layout : {Layout::kGim, Layout::kMcgim, Layout::kTiles}) {
        for (const uint32_t effort : {kLeastEffort, kMostEffort}) {
            const auto encoded = encode(mesh, options_of(effort, kPsnr, layout));
            ASSERT_TRUE(encoded.ok()) << encoded.error().message;
            EXPECT_GE(encoded.value().report.error.psnr, kPsnr.value) << int(layout) << " " << effort;
        }
    }
}

TEST(Effort, MoreOfItTakesFewerBytes) {
    const TriangleMesh mesh = bumpy_torus();
    const auto cost = [&](uint32_t effort) {
        const Encoded encoded = encode(mesh, options_of(effort, {RateTarget::Kind::kQuality, 60})).value();
        return log_bytes(double(encoded.bytes.size()), encoded.report.error.psnr);
    };
    const double least = cost(kLeastEffort);
    EXPECT_LT(cost(EncodeOptions{}.effort), least - 0.03);
    EXPECT_LT(cost(kMostEffort), least - 0.03);
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

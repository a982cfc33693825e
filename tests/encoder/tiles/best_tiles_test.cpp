#include "encoder/tiles/best_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "format/tile_atlas.h"

namespace gim {
namespace {

// Runs whose files have known costs. Notes which numbers of tiles are tried.
struct KnownRuns {
    std::map<uint32_t, double> bytes_of;  // per number of tiles, at the target
    std::vector<uint32_t> tried;

    CodingRuns runs() {
        const auto code = [](const EncodeOptions&, const Contest&) -> Result<Encoded> { return Error{}; };
        const auto estimate = [this](const EncodeOptions& options, std::optional<double>) -> Result<Estimate> {
            tried.push_back(options.tiles);
            return Estimate{log_bytes(bytes_of.at(options.tiles), options.rate.value), 1};
        };
        return {code, estimate};
    }
};

EncodeOptions options_for(double psnr) {
    EncodeOptions options;
    options.layout = Layout::kTiles;
    options.rate = {RateTarget::Kind::kPsnr, psnr};
    return options;
}

std::vector<uint32_t> numbers_tried(const std::map<uint32_t, double>& bytes_of) {
    KnownRuns known{bytes_of, {}};
    const auto tried = try_tiles(known.runs(), options_for(65), false);
    EXPECT_TRUE(tried.ok());
    double last = -HUGE_VAL;
    for (const TriedTiles& each : tried.value()) {
        EXPECT_GE(each.estimate.log_bytes, last);
        last = each.estimate.log_bytes;
    }
    return known.tried;
}

TEST(BestTiles, FewBytesAskForFewerTilesAndManyForMore) {
    EXPECT_EQ(numbers_tried({{120, 1500}, {60, 1200}, {180, 1800}}), (std::vector<uint32_t>{120, 60}));
    EXPECT_EQ(numbers_tried({{120, 5000}, {60, 5500}, {180, 4500}}), (std::vector<uint32_t>{120, 180}));
}

TEST(BestTiles, BothOthersAreTriedUnlessOneIsClearlyBetter) {
    EXPECT_EQ(numbers_tried({{120, 1500}, {60, 1600}, {180, 1400}}), (std::vector<uint32_t>{120, 60, 180}));
    EXPECT_EQ(numbers_tried({{120, 1500}, {60, 1495}, {180, 1400}}), (std::vector<uint32_t>{120, 60, 180}));
    EXPECT_EQ(numbers_tried({{120, 5000}, {60, 4500}, {180, 5100}}), (std::vector<uint32_t>{120, 180, 60}));
}

TEST(BestTiles, UsualNumberComesAlone) {
    KnownRuns known{{{120, 1500}, {60, 1200}, {180, 1800}}, {}};
    const auto tried = try_usual_tiles(known.runs(), options_for(65), false);
    ASSERT_TRUE(tried.ok());
    EXPECT_EQ(tried.value().size(), 1u);
    EXPECT_EQ(known.tried, std::vector<uint32_t>{120});
}

TEST(BestTiles, AllThatIsTriedWasLikely) {
    for (const bool has_creases : {false, true}) {
        for (const uint32_t effort : {4u, 5u}) {
            for (const uint32_t tiles : {0u, 77u}) {
                EncodeOptions options = options_for(65);
                options.effort = effort;
                options.tiles = tiles;
                std::vector<EncodeOptions> likely = likely_tiles(options, has_creases);
                const auto is_likely = [&](const EncodeOptions& now) {
                    return std::any_of(likely.begin(), likely.end(), [&](const EncodeOptions& other) {
                        return other.tiles == now.tiles && other.creases == now.creases;
                    });
                };
                size_t tried = 0;
                const auto estimate = [&](const EncodeOptions& now, std::optional<double>) -> Result<Estimate> {
                    EXPECT_TRUE(is_likely(now)) << now.tiles;
                    ++tried;
                    return Estimate{log_bytes(now.creases ? 1000 : 1500, now.rate.value), 1};
                };
                const auto code = [](const EncodeOptions&, const Contest&) -> Result<Encoded> { return Error{}; };
                ASSERT_TRUE(try_tiles({code, estimate}, options, has_creases).ok());
                EXPECT_EQ(tried, likely.size());
            }
        }
    }
}

TEST(BestTiles, NumberThatIsAskedForStays) {
    KnownRuns known{{{77, 1500}}, {}};
    EncodeOptions options = options_for(65);
    options.tiles = 77;
    ASSERT_TRUE(try_tiles(known.runs(), options, false).ok());
    EXPECT_EQ(known.tried, std::vector<uint32_t>{77});
}

TEST(BestTiles, AtlasesWithoutLossFillTheSamples) {
    for (const uint64_t samples : {1000u, 5000u, 20000u, 65536u, 1000000u, 16785409u}) {
        const uint32_t tiles = tiles_that_fill(samples);
        uint64_t most = 0;
        for (uint32_t exponent = 1; exponent <= kMostTileExponent; ++exponent) {
            const uint64_t now = TileAtlas(tiles, 1u << exponent).samples();
            if (now <= samples) most = now;
        }
        EXPECT_GT(double(most), 0.9 * double(samples)) << samples;
        EXPECT_GE(tiles, kUsualTiles / 3) << samples;
        EXPECT_LE(tiles, kUsualTiles * 3) << samples;
    }
}

}  // namespace
}  // namespace gim

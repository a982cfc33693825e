#include "decoder/pyramid/range_decoder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "encoder/code/range_encoder.h"
#include "format/band_code.h"
#include "tests/format/random_sideband.h"

namespace gim {
namespace {

using test::Random;

TEST(RangeCoder, BitsAndRawBitsComeBackWhateverFollows) {
    Random random(1);
    for (int round = 0; round < 300; ++round) {
        struct Item {
            uint32_t model, value, count;  // count 0: a modelled bit
        };
        std::vector<Item> items;
        const uint32_t length = random.below(round < 150 ? 40 : 3000);
        const uint32_t skew = 1 + random.below(200);
        for (uint32_t i = 0; i < length; ++i) {
            if (random.below(4) == 0) {
                const uint32_t count = 1 + random.below(24);
                items.push_back({0, random.next() & ((1u << count) - 1), count});
            } else {
                items.push_back({random.below(8), random.below(skew) == 0 ? 1u : 0u, 0});
            }
        }
        RangeEncoder encoder;
        BitModel write_models[8], read_models[8];
        for (const Item& i : items) {
            if (i.count) {
                encoder.code_raw(i.value, i.count);
            } else {
                encoder.code_bit(write_models[i.model], i.value);
            }
        }
        const std::vector<uint8_t> stream = encoder.finish();
        RangeDecoder decoder(stream);
        for (const Item& i : items)
            ASSERT_EQ(i.count ? decoder.code_raw(0, i.count) : decoder.code_bit(read_models[i.model]), i.value);
        EXPECT_TRUE(decoder.intact());
    }
}

TEST(RangeCoder, LongRunsOfTheLikelyBitAndCarriesSurvive) {
    // The unlikely bit, repeated, drives low to the top of its range. Carries then run through many bytes.
    for (const uint32_t period : {1u, 2u, 3u, 17u, 1000u}) {
        RangeEncoder encoder;
        BitModel w, r;
        for (uint32_t i = 0; i < 20000; ++i) encoder.code_bit(w, i % period == 0);
        const auto stream = encoder.finish();
        RangeDecoder decoder(stream);
        for (uint32_t i = 0; i < 20000; ++i)
            ASSERT_EQ(decoder.code_bit(r), i % period == 0 ? 1u : 0u) << period << " " << i;
    }
}

TEST(RangeCoder, StreamsEndWithTheirLastNeededByte) {
    EXPECT_TRUE(RangeEncoder().finish().empty());
    Random random(7);
    for (int round = 0; round < 300; ++round) {
        RangeEncoder encoder;
        BitModel models[8];
        double bits = 0;
        const uint32_t skew = 1 + random.below(200);
        for (uint32_t i = 0; i < random.below(400); ++i) {
            BitModel& model = models[random.below(8)];
            const uint32_t bit = random.below(skew) == 0;
            bits -= std::log2(std::abs(bit - model.zero_probability() / 65536.0));
            encoder.code_bit(model, bit);
        }
        // Less than one byte more than the information, rounded up to whole bytes.
        EXPECT_LT(static_cast<double>(encoder.finish().size()), bits / 8 + 2);
    }
}

TEST(RangeCoder, ComesNearTheEntropy) {
    Random random(2);
    RangeEncoder encoder;
    BitModel model;
    const double p = 0.05;
    const uint32_t n = 200000;
    for (uint32_t i = 0; i < n; ++i) encoder.code_bit(model, random.unit() < p ? 1 : 0);
    const double entropy = n * -(p * std::log2(p) + (1 - p) * std::log2(1 - p)) / 8;
    EXPECT_LT(double(encoder.finish().size()), entropy * 1.05);
}

TEST(RangeCoder, MissingRawBitsAreNoticed) {
    const std::vector<uint8_t> stream = {1, 2, 3};
    RangeDecoder decoder(stream);
    EXPECT_EQ(decoder.code_raw(0, 24), 0x010203u);
    EXPECT_TRUE(decoder.intact());
    (void)decoder.code_raw(0, 1);
    EXPECT_FALSE(decoder.intact());
}

// Bands of every size and kind of content come back; the last value must fit 25 bits.
TEST(BandCoder, RandomLevelsRoundTrip) {
    Random random(3);
    for (int round = 0; round < 200; ++round) {
        const uint32_t top = 1 + random.below(6);  // levels of side 3, 5, ..
        const uint32_t largest = random.below(25);
        const uint32_t emptiness = random.below(3) == 0 ? 1 : 1 + random.below(60);
        std::vector<std::vector<int32_t>> sent, got;
        const auto fill = [&](size_t count) {
            std::vector<int32_t> values(count);
            for (int32_t& v : values) {
                if (random.below(emptiness) != 0) continue;
                const int32_t magnitude = static_cast<int32_t>(random.below(2u << random.below(largest + 1)));
                v = random.below(2) ? magnitude : -magnitude;
            }
            return values;
        };
        for (uint32_t e = 0; e < top; ++e) {
            const size_t h = size_t{1} << e;
            for (const size_t count : {(h + 1) * h, h * (h + 1), h * h}) sent.push_back(fill(count * 3));
        }
        for (const auto& s : sent) got.emplace_back(s.size(), -77);
        const uint32_t widest = (1u << top) + 2;
        OwnBandWork work(widest);
        const auto level = [&](std::vector<std::vector<int32_t>>& all, uint32_t e) {
            const uint32_t h = 1u << e;
            return LevelBands{
                {all[e * 3].data(), h + 1, h}, {all[e * 3 + 1].data(), h, h + 1}, {all[e * 3 + 2].data(), h, h}};
        };
        const auto kind = round % 2 ? CoefficientKind::kPlain : CoefficientKind::kInFrames;
        const auto code_all = [&](auto& coder, std::vector<std::vector<int32_t>>& all) {
            BandModels models(kind);
            BandCoder band_coder(&coder, &models, work.view());
            for (uint32_t e = 0; e < top; ++e) {
                const LevelBands parents = level(all, e ? e - 1 : 0);
                ASSERT_TRUE(band_coder.code_level(level(all, e), e ? &parents : nullptr));
            }
        };
        RangeEncoder encoder;
        code_all(encoder, sent);
        const auto stream = encoder.finish();
        RangeDecoder decoder(stream);
        code_all(decoder, got);
        ASSERT_EQ(got, sent) << round;
        EXPECT_TRUE(decoder.intact());
    }
}

TEST(BandCoder, AnyBytesDecodeOrAreRefused) {
    Random random(4);
    uint32_t refused = 0;
    for (int round = 0; round < 500; ++round) {
        std::vector<uint8_t> stream(random.below(300));
        for (uint8_t& b : stream) b = static_cast<uint8_t>(round % 3 == 0 ? 0xFF : random.next());
        std::vector<int32_t> a(17 * 16 * 3), b(16 * 17 * 3), c(16 * 16 * 3);
        OwnBandWork work(17);
        RangeDecoder decoder(stream);
        BandModels models(round % 2 ? CoefficientKind::kPlain : CoefficientKind::kInFrames);
        BandCoder coder(&decoder, &models, work.view());
        refused += !coder.code_level({{a.data(), 17, 16}, {b.data(), 16, 17}, {c.data(), 16, 16}}, nullptr) ||
                   !decoder.intact();
        for (const int32_t v : a) ASSERT_LT(magnitude_of(v), 1u << 25);
    }
    EXPECT_GT(refused, 100u);
}

}  // namespace
}  // namespace gim

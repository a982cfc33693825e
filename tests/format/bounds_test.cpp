#include "format/bounds.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gim {
namespace {

Units units_of(uint32_t bits, float step) {
    Units units;
    units.bits = bits;
    units.origin = {-10, 0, 1000};
    units.step = step;
    return units;
}

TEST(Bounds, CodesOfErrorsAreTenthsOfOctavesOfTheExtent) {
    const Units units = units_of(12, 0.25f);  // extent 1024
    EXPECT_EQ(error_of(0, units), 0.0f);
    EXPECT_EQ(error_of(247, units), 1024.0f);
    EXPECT_EQ(error_of(237, units), 512.0f);
    EXPECT_FLOAT_EQ(error_of(252, units), 1024 * std::sqrt(2.0f));
    EXPECT_FLOAT_EQ(error_of(1, units), 1024 * std::exp2(-24.6f));
    for (uint32_t k = 2; k < 256; ++k) {
        const float before = error_of(static_cast<uint8_t>(k - 1), units),
                    now = error_of(static_cast<uint8_t>(k), units);
        EXPECT_NEAR(now / before, std::exp2(0.1f), 1e-6f) << k;
    }
}

TEST(Bounds, ErrorsAreRoundedUpByLittle) {
    for (const uint32_t bits : {8u, 12u, 20u}) {
        for (const float step : {0x1p-100f, 0.003f, 0x1p76f}) {
            const Units units = units_of(bits, step);
            const double extent = std::ldexp(double{step}, static_cast<int>(bits));
            for (double error = extent * 1e-7; error < 1.7 * extent; error *= 1.37) {
                const auto told = static_cast<double>(error_of(error_code_of(error, units), units));
                EXPECT_GE(told, error);
                EXPECT_LE(told, 1.072 * error);
            }
            EXPECT_EQ(error_code_of(0, units), 1);
            EXPECT_EQ(error_code_of(2 * extent, units), 255);
        }
    }
}

TEST(Bounds, BoxesAreNineBitsAFace) {
    BoxNumbers numbers, back;
    numbers.of = {128, 0, 511, 384, 1, 511};
    std::vector<uint8_t> bytes;
    append_box(numbers, &bytes);
    // 010000000 000000000 111111111 110000000 000000001 111111111 00
    EXPECT_EQ(bytes, (std::vector<uint8_t>{0x40, 0x00, 0x3F, 0xF8, 0x00, 0x0F, 0xFC}));
    ASSERT_EQ(bytes.size(), kBoxSize);
    const std::span<const uint8_t, kBoxSize> stored(bytes);
    ASSERT_TRUE(read_box(stored, &back));
    EXPECT_EQ(back.of, numbers.of);
    const Box box = back.box(units_of(12, 0.25f));  // 16 units a number
    EXPECT_EQ(box.low, (std::array<float, 3>{-10, -512, 1000 + 4 * 383}));
    EXPECT_EQ(box.high, (std::array<float, 3>{1014, -508, 1000 + 4 * 383}));
    bytes.back() |= 1;
    EXPECT_FALSE(read_box(stored, &back));
}

TEST(Bounds, ABoxAroundABoxIsTheLeast) {
    const Units units = units_of(10, 0.01f);
    const Box inside = {{-9.995f, 0.0f, 1000.3f}, {-5.5f, 0.0f, 1003.0f}};
    const BoxNumbers numbers = box_around(inside, units);
    ASSERT_TRUE(numbers.is_told());
    for (size_t k = 0; k < 3; ++k) {
        EXPECT_LE(box_coordinate(numbers.of[k], k, units), inside.low[k]);
        EXPECT_GT(box_coordinate(numbers.of[k] + 1, k, units), inside.low[k]);
        EXPECT_GE(box_coordinate(numbers.of[k + 3], k, units), inside.high[k]);
        EXPECT_LT(box_coordinate(numbers.of[k + 3] - 1, k, units), inside.high[k]);
    }
}

TEST(Bounds, ABoxFarFromTheOriginIsNotTold) {
    const Units units = units_of(10, 0.01f);  // numbers reach from -0.5 to 1.49 extents of 10.24
    EXPECT_FALSE(box_around({{-16, 0, 1000}, {-9, 0, 1001}}, units).is_told());
    EXPECT_FALSE(box_around({{-10, 0, 1000}, {-9, 15.4f, 1001}}, units).is_told());
}

}  // namespace
}  // namespace gim

#include "encoder/code/quantizer_bracket.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "encoder/code/rate_target.h"

namespace gim {
namespace {

struct Found {
    std::optional<double> octave;  // the coarsest that meets the target
    int files = 0;
};

// Searches like the encoder. margin: of a quantizer, by its base-2 logarithm.
Found found(double first, const std::function<double(double)>& margin) {
    QuantizerBracket bracket(4.3);
    Found result;
    std::optional<double> quantizer = std::exp2(first);
    while (quantizer && result.files < 100) {
        const double octave = std::log2(*quantizer), now = margin(octave);
        if (now >= 0) result.octave = std::max(octave, result.octave.value_or(octave));
        bracket.add(*quantizer, now);
        ++result.files;
        quantizer = bracket.next();
    }
    return result;
}

TEST(QuantizerBracket, FindsTheCoarsestFromEitherSide) {
    for (const double first : {-3.0, 2.0, 4.9, 9.0}) {
        const Found result = found(first, [](double octave) { return 3.5 * (5 - octave); });
        ASSERT_TRUE(result.octave.has_value()) << first;
        EXPECT_LE(*result.octave, 5) << first;
        EXPECT_GE(*result.octave, 4.95) << first;
        EXPECT_LE(result.files, 14) << first;
    }
}

TEST(QuantizerBracket, NoiseDoesNotLeadItAstray) {
    for (double phase = 0; phase < 6; phase += 0.5) {
        const Found result = found(7, [&](double octave) { return 4 * (5 - octave) + std::sin(9 * octave + phase); });
        ASSERT_TRUE(result.octave.has_value()) << phase;
        EXPECT_NEAR(*result.octave, 5, 0.3) << phase;
        EXPECT_LE(result.files, 12) << phase;
    }
}

TEST(QuantizerBracket, GivesUpWhereFinerQuantizersGainNothing) {
    const Found result = found(5, [](double octave) { return std::min(-1.0, -2 * octave); });
    EXPECT_FALSE(result.octave.has_value());
    EXPECT_LE(result.files, 8);
}

TEST(QuantizerBracket, GoesBeyondASmallMarginOfTheSamples) {
    const Found result =
        found(RateSearchValues::kFinest, [](double octave) { return std::min(0.1, 4 * (3 - octave)); });
    ASSERT_TRUE(result.octave.has_value());
    EXPECT_GE(*result.octave, 2.8);
}

TEST(QuantizerBracket, ComesBackFromQuantizersThatLeaveNoSurface) {
    constexpr double kNothing = -RateSearchValues::kMostMargin;
    const Found result = found(18, [](double octave) { return octave > 6 ? kNothing : 10 - octave; });
    ASSERT_TRUE(result.octave.has_value());
    EXPECT_GE(*result.octave, 5.9);
}

TEST(QuantizerBracket, EndsAtTheLastQuantizers) {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    EXPECT_EQ(found(2, [](double) { return kInfinite; }).octave, RateSearchValues::kCoarsest);
    EXPECT_LE(found(2, [](double octave) { return octave < 0 ? kInfinite : -1.0; }).files, 20);
    EXPECT_EQ(found(RateSearchValues::kFinest, [](double) { return -1.0; }).files, 1);
}

}  // namespace
}  // namespace gim

#include "encoder/code/coefficient_prices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "encoder/code/code_bands.h"
#include "tests/format/random_sideband.h"

namespace gim {
namespace {

using test::Random;

constexpr uint32_t kSide = 129;

Pyramid<int32_t> zero_bands() {
    Pyramid<int32_t> bands;
    bands.columns = bands.rows = kSide;
    bands.base.resize(12);
    for (uint32_t highs = 1; highs < kSide - 1; highs *= 2) {
        const size_t edge = size_t{3} * highs * (highs + 1);
        bands.levels.push_back(
            {std::vector<int32_t>(edge), std::vector<int32_t>(edge), std::vector<int32_t>(size_t{3} * highs * highs)});
    }
    return bands;
}

template <class F>
void for_each_band(Pyramid<int32_t>& bands, const F& f) {
    for (uint32_t level = 0; level < bands.steps(); ++level) {
        const LevelBands of_level = bands_of(bands, level);
        for (const auto orientation : {Orientation::kHorizontal, Orientation::kVertical, Orientation::kDiagonal})
            f(of_level.of(orientation));
    }
}

// How large the details of a component are at a place: rows and columns count from 0 to 1.
using Spread = double (*)(double row, double column, uint32_t k);

// Laplacian details, as those of a surface are.
Pyramid<int32_t> random_bands(uint64_t seed, Spread spread) {
    Random random(seed);
    Pyramid<int32_t> bands = zero_bands();
    for_each_band(bands, [&](const Band& band) {
        for (uint32_t row = 0; row < band.rows; ++row) {
            for (uint32_t column = 0; column < band.columns; ++column) {
                for (uint32_t k = 0; k < 3; ++k) {
                    const double size = spread(double(row) / band.rows, double(column) / band.columns, k);
                    const double value = -size * std::log(1 - double{random.unit()});
                    band.row(row)[3 * column + k] =
                        (random.below(2) ? 1 : -1) * static_cast<int32_t>(std::floor(value + 0.4));
                }
            }
        }
    });
    return bands;
}

double everywhere_small(double, double, uint32_t k) { return k == 0 ? 0.25 : 0.12; }
// Sparse but for a stripe.
double in_a_stripe(double row, double, uint32_t k) {
    const double in_stripe = std::exp(-50 * (row - 0.3) * (row - 0.3));
    return (k == 0 ? 0.15 : 0.08) + (k == 0 ? 4 : 1) * in_stripe;
}

double coded_bits(Pyramid<int32_t> bands) {
    double bits = 0;
    for (const auto& stream : code_bands(bands, 1, CoefficientKind::kInFrames)) bits += 8 * double(stream.size());
    return bits;
}

TEST(CoefficientPrices, ALonelyOneCostsMoreThanOneAmongLargeOnes) {
    Pyramid<int32_t> bands = random_bands(1, in_a_stripe);
    const Band finest = bands_of(bands, bands.steps() - 1).horizontal;
    // The lower half of the band is made empty. A block of the stripe is made large.
    for (uint32_t row = 40; row < finest.rows; ++row) std::fill_n(finest.row(row), 3 * finest.columns, 0);
    for (uint32_t row = 18; row < 23; ++row) {
        for (uint32_t i = 60; i < 75; ++i) finest.row(row)[i] = 5;
    }
    finest.row(20)[3 * 22] = 0;
    const CoefficientPrices prices({&bands, 1});
    const double lonely = prices.bits_of_change(finest, 55, 20, 0, 1),
                 among_large = prices.bits_of_change(finest, 20, 22, 0, 1);
    EXPECT_GT(lonely, 4);
    EXPECT_LT(among_large, 2);
    EXPECT_GT(lonely, among_large + 4);
}

TEST(CoefficientPrices, UndoingAChangeCostsMinusItsPrice) {
    Pyramid<int32_t> bands = random_bands(2, in_a_stripe);
    const CoefficientPrices prices({&bands, 1});
    for_each_band(bands, [&](const Band& band) {
        for (const uint32_t row : {0u, band.rows / 3, band.rows - 1}) {
            for (const uint32_t column : {0u, band.columns / 2, band.columns - 1}) {
                for (uint32_t k = 0; k < 3; ++k) {
                    for (const int32_t by : {-20, -1, 1, 2}) {
                        int32_t& detail = band.row(row)[3 * column + k];
                        const double change = prices.bits_of_change(band, row, column, k, by);
                        detail += by;
                        const double back = prices.bits_of_change(band, row, column, k, -by);
                        detail -= by;
                        EXPECT_NEAR(change + back, 0, 1e-9);
                    }
                }
            }
        }
    });
}

TEST(CoefficientPrices, TheSignOfADetailDoesNotMatter) {
    Pyramid<int32_t> bands = random_bands(3, in_a_stripe);
    const CoefficientPrices prices({&bands, 1});
    const Band finest = bands_of(bands, bands.steps() - 1).diagonal;
    int32_t& detail = finest.row(20)[31];
    detail = -2;
    const double grows = prices.bits_of_change(finest, 20, 10, 1, -1);
    detail = 2;
    EXPECT_EQ(prices.bits_of_change(finest, 20, 10, 1, 1), grows);
    EXPECT_EQ(prices.bits_of_change(finest, 20, 10, 1, -4), 0);
}

// Returns what the details gain together when they vanish one by one.
double price_of_all(const CoefficientPrices& prices, Pyramid<int32_t> bands, bool last_first) {
    double sum = 0;
    for_each_band(bands, [&](const Band& band) {
        const auto count = static_cast<uint32_t>(band.count());
        for (uint32_t n = 0; n < count; ++n) {
            const uint32_t i = last_first ? count - 1 - n : n, triple = i / 3;
            int32_t& detail = band.values[i];
            sum -= prices.bits_of_change(band, triple / band.columns, triple % band.columns, i % 3, -detail);
            detail = 0;
        }
    });
    return sum;
}

TEST(CoefficientPrices, TheSumOverAllDetailsIsAboutWhatTheCoderTakes) {
    for (const Spread spread : {everywhere_small, in_a_stripe}) {
        const Pyramid<int32_t> bands = random_bands(4, spread);
        const double coded = coded_bits(bands) - coded_bits(zero_bands());
        const double sum = price_of_all(CoefficientPrices({&bands, 1}), bands, false);
        EXPECT_GT(sum, 0.5 * coded);
        EXPECT_LT(sum, 2 * coded);
    }
}

TEST(CoefficientPrices, TheOrderOfChangesDoesNotMatter) {
    const Pyramid<int32_t> bands = random_bands(5, in_a_stripe);
    const CoefficientPrices prices({&bands, 1});
    EXPECT_NEAR(price_of_all(prices, bands, false), price_of_all(prices, bands, true), 1e-6);
}

}  // namespace
}  // namespace gim

#include "encoder/code/extend_chart.h"

#include <gtest/gtest.h>

#include <cmath>

#include "encoder/code/code_bands.h"
#include "tests/format/random_sideband.h"

namespace gim {
namespace {

using test::Random;

constexpr uint32_t kColumns = 37, kRows = 26, kSteps = 4;

// A slope with bumps.
std::vector<float> slope() {
    std::vector<float> values;
    for (uint32_t r = 0; r < kRows; ++r) {
        for (uint32_t c = 0; c < kColumns; ++c) {
            const double u = c, v = r;
            for (const double x : {1500 + 20 * u - 9 * v, 800 + 300 * std::sin(u / 6) * std::cos(v / 5), 40 * v + u})
                values.push_back(static_cast<float>(std::round(x)));
        }
    }
    return values;
}
// The samples that lie in an ellipse.
std::vector<uint8_t> ellipse() {
    std::vector<uint8_t> defined;
    for (uint32_t r = 0; r < kRows; ++r) {
        for (uint32_t c = 0; c < kColumns; ++c) defined.push_back(std::hypot((c - 17.0) / 15, (r - 14.0) / 9) <= 1);
    }
    return defined;
}

template <class Wavelet>
std::vector<typename Wavelet::Sample> masked_slope(const std::vector<uint8_t>& defined) {
    const std::vector<float> values = slope();
    std::vector<typename Wavelet::Sample> image(values.begin(), values.end());
    for (size_t i = 0; i < image.size(); ++i) {
        if (!defined[i / 3]) image[i] = 0;
    }
    return image;
}

size_t coded_size(const Pyramid<float>& pyramid) {
    Pyramid<int32_t> bands = quantize_bands(pyramid, {6}).bands;
    return code_bands(bands, 1)[0].size();
}
size_t coded_size(Pyramid<int32_t> pyramid) { return code_bands(pyramid, 1)[0].size(); }

template <class Wavelet>
class ExtendChart : public ::testing::Test {};
using Wavelets = ::testing::Types<Reversible53, Irreversible97>;
TYPED_TEST_SUITE(ExtendChart, Wavelets);

TYPED_TEST(ExtendChart, DefinedSamplesStayAndBytesBecomeFewer) {
    const std::vector<uint8_t> defined = ellipse();
    const auto image = masked_slope<TypeParam>(defined);
    const auto extended = extend_chart<TypeParam>(image, defined, kColumns, kRows, kSteps, 4);
    ASSERT_EQ(extended.size(), image.size());
    for (size_t i = 0; i < image.size(); ++i) {
        if (defined[i / 3]) {
            ASSERT_EQ(extended[i], image[i]);
        }
    }
    const size_t zeros = coded_size(analyse<TypeParam>(image, kColumns, kRows, kSteps)),
                 smooth = coded_size(analyse<TypeParam>(extended, kColumns, kRows, kSteps));
    EXPECT_LT(2 * smooth, zeros);
}

TYPED_TEST(ExtendChart, AWholeBoxStaysAsItIs) {
    const std::vector<uint8_t> all(size_t{kColumns} * kRows, 1);
    const auto image = masked_slope<TypeParam>(all);
    EXPECT_EQ(extend_chart<TypeParam>(image, all, kColumns, kRows, kSteps, 4), image);
}

TYPED_TEST(ExtendChart, ASingleSampleBecomesAConstant) {
    std::vector<uint8_t> defined(size_t{kColumns} * kRows, 0);
    defined[700] = 1;
    const auto image = masked_slope<TypeParam>(defined);
    const auto extended = extend_chart<TypeParam>(image, defined, kColumns, kRows, kSteps, 4);
    for (size_t i = 0; i < image.size(); ++i) ASSERT_NEAR(extended[i], image[2100 + i % 3], 1);
}

TYPED_TEST(ExtendChart, BoxesWithoutAStepAreFilledToo) {
    using Sample = typename TypeParam::Sample;
    const std::vector<Sample> image = {5, 6, 7, 0, 0, 0, 9, 8, 7, 0, 0, 0, 0, 0, 0, 1, 2, 3};
    const auto extended = extend_chart<TypeParam>(image, {1, 0, 1, 0, 0, 1}, 2, 3, 0, 1);
    EXPECT_EQ(std::vector<Sample>(extended.begin(), extended.begin() + 3), (std::vector<Sample>{5, 6, 7}));
    EXPECT_EQ(std::vector<Sample>(extended.end() - 3, extended.end()), (std::vector<Sample>{1, 2, 3}));
    for (const Sample v : extended) EXPECT_TRUE(v >= 1 && v <= 9);
}

TYPED_TEST(ExtendChart, NoiseStaysWhereItIsDefined) {
    Random random(5);
    using Sample = typename TypeParam::Sample;
    for (int round = 0; round < 5; ++round) {
        const uint32_t columns = 3 + random.below(20), rows = 3 + random.below(20);
        std::vector<Sample> image;
        std::vector<uint8_t> defined;
        for (uint32_t i = 0; i < columns * rows; ++i) {
            defined.push_back(random.below(3) > 0);
            for (int k = 0; k < 3; ++k) image.push_back(static_cast<Sample>(random.below(1u << 20)));
        }
        defined[0] = 1;
        const auto extended = extend_chart<TypeParam>(image, defined, columns, rows, 1, 8);
        for (size_t i = 0; i < image.size(); ++i) {
            if (defined[i / 3]) {
                ASSERT_EQ(extended[i], image[i]);
            }
        }
    }
}

}  // namespace
}  // namespace gim

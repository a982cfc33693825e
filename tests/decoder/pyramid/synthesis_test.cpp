#include "decoder/pyramid/synthesis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/format/random_sideband.h"

namespace gim {
namespace {

using test::Random;

// The bands that make a rectangle, all zero.
struct Bands {
    std::vector<int32_t> values;
    LevelBands level;

    Bands(uint32_t columns, uint32_t rows) : values(3 * size_t{columns} * rows) {
        level.horizontal = {values.data(), low_count(rows), high_count(columns)};
        level.vertical = {level.horizontal.values + level.horizontal.count(), high_count(rows), low_count(columns)};
        level.diagonal = {level.vertical.values + level.vertical.count(), high_count(rows), high_count(columns)};
    }
};

std::vector<float> synthesized(uint32_t columns, uint32_t rows, const std::vector<float>& low, const Bands& bands,
                               const DetailSteps& steps) {
    std::vector<float> work(synthesis_work_size(columns)), image(3 * size_t{columns} * rows);
    synthesize<Irreversible97>(columns, rows, low.data(), bands.level, steps, work.data(), image.data());
    return image;
}

// The plane that is spanned by two vectors.
std::vector<float> plane(uint32_t columns, uint32_t rows, const std::array<float, 3>& along,
                         const std::array<float, 3>& across) {
    std::vector<float> image;
    for (uint32_t row = 0; row < rows; ++row) {
        for (uint32_t column = 0; column < columns; ++column) {
            for (size_t k = 0; k < 3; ++k)
                image.push_back(static_cast<float>(column) * along[k] + static_cast<float>(row) * across[k]);
        }
    }
    return image;
}

constexpr DetailSteps kPlain{4, 3, false, 1, 0}, kFramed{4, 3, true, 2.5f, 100};

TEST(Synthesis, ZeroDetailsAreTheSameWithAndWithoutFrames) {
    Random random(1);
    for (const auto& [columns, rows] : {std::pair{33u, 33u}, std::pair{30u, 23u}, std::pair{3u, 3u}}) {
        std::vector<float> low(3 * size_t{low_count(columns)} * low_count(rows));
        for (float& x : low) x = 1000 * random.unit();
        const Bands none(columns, rows);
        EXPECT_EQ(synthesized(columns, rows, low, none, kFramed), synthesized(columns, rows, low, none, kPlain));
    }
}

// On a flat image a first value moves samples along the normal only, the others within the surface only.
TEST(Synthesis, FirstValueIsAlongTheNormalAndTheOthersAreNot) {
    const std::vector<float> low = plane(17, 17, {3, 4, 0}, {-4, 3, 0});
    const std::vector<float> flat = synthesized(33, 33, low, Bands(33, 33), kFramed);
    Random random(2);
    for (const bool normal : {true, false}) {
        Bands bands(33, 33);
        for (size_t i = 0; i < 3 * 33 * 33 - low.size(); ++i) {
            if ((i % 3 == 0) == normal) bands.values[i] = static_cast<int32_t>(random.below(9)) - 4;
        }
        const std::vector<float> image = synthesized(33, 33, low, bands, kFramed);
        double within = 0, out = 0;
        for (size_t i = 0; i < image.size(); ++i) (i % 3 == 2 ? out : within) += std::abs(double{image[i]} - flat[i]);
        EXPECT_GT(normal ? out : within, 1000.0);
        EXPECT_LT(normal ? within : out, 0.1);
    }
}

// If a frame's axes are z, x, y, framed values are reordered unframed ones with steps of their own.
TEST(Synthesis, FramesTurnDetailsAndScaleTheirSteps) {
    const std::vector<float> low = plane(17, 17, {5, 0, 0}, {0, 5, 0});  // cells of 25 units^2: scale (400 / 25)^(1/4)
    const DetailSteps steps{4, 3, true, 2.5f, 400};
    Bands framed(33, 33), plain(33, 33);
    const auto set = [](const Band& band, uint32_t row, uint32_t column, const std::array<int32_t, 3>& values) {
        std::copy(values.begin(), values.end(), band.row(row) + 3 * size_t{column});
    };
    set(framed.level.horizontal, 7, 7, {-3, 0, 0});
    set(plain.level.horizontal, 7, 7, {0, 0, -3});
    set(framed.level.diagonal, 2, 11, {2, 0, 0});
    set(plain.level.diagonal, 2, 11, {0, 0, 2});
    const std::vector<float> a = synthesized(33, 33, low, framed, steps),
                             b = synthesized(33, 33, low, plain, {8, 6, false, 1, 0});
    for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-4f) << i;

    framed = Bands(33, 33), plain = Bands(33, 33);
    set(framed.level.vertical, 5, 9, {0, 7, -1});
    set(plain.level.vertical, 5, 9, {7, -1, 0});
    const std::vector<float> c = synthesized(33, 33, low, framed, steps),
                             d = synthesized(33, 33, low, plain, {10, 1, false, 1, 0});
    for (size_t i = 0; i < c.size(); ++i) EXPECT_NEAR(c[i], d[i], 1e-4f) << i;
}

TEST(Synthesis, LargestValuesOnHostileImagesStayFinite) {
    Random random(3);
    constexpr float kLargest = 0x1p45f;  // more than a base makes
    std::vector<float> low(3 * 17 * 17);
    for (float& x : low) x = random.below(3) == 0 ? kLargest : random.below(2) == 0 ? -kLargest : random.unit();
    Bands bands(33, 33);
    for (int32_t& v : bands.values) v = random.below(2) == 0 ? (1 << 25) - 1 : 1 - (1 << 25);
    const DetailSteps steps{0x1p20f, 0x1p20f, true, 255.0f / 8, 1};
    for (const float x : synthesized(33, 33, low, bands, steps)) ASSERT_TRUE(std::isfinite(x));
}

}  // namespace
}  // namespace gim

#include "encoder/squares/write_squares.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "encoder/code/file_units.h"
#include "format/seam.h"
#include "gim/decoder.hpp"
#include "tests/format/random_sideband.h"

namespace gim {
namespace {

using test::Random;

// A bumpy height field with noise; the ring's classes agree.
SquareImage bumpy(uint32_t side, uint64_t seed, Sideband sideband = {}) {
    Random random(seed);
    SquareGrid image{side, {}};
    for (uint32_t r = 0; r < side; ++r)
        for (uint32_t c = 0; c < side; ++c) {
            const double u = double(c) / (side - 1), v = double(r) / (side - 1);
            image.positions.emplace_back(u + 1e-3 * random.unit(), 2 * v, 0.3 * std::sin(9 * u + 5 * v * v));
        }
    SeamTable seams;
    EXPECT_EQ(build_seam_table(sideband, &seams), Status::kOk);
    std::vector<uint32_t> class_of(ring_length(side));
    ring_classes(seams, side, class_of);
    std::vector<Vec3> first(class_of.size(), Vec3::Constant(NAN));
    for (uint32_t k = 0; k < class_of.size(); ++k) {
        const GridPoint p = ring_point(side, k);
        Vec3& x = first[class_of[k]];
        if (std::isnan(x.x())) x = image.at(p.row, p.column);
        image.at(p.row, p.column) = x;
    }
    return glue_square(std::move(image), std::move(sideband)).value();
}

struct Decoded {
    gim_info info{};
    DecoderLevel level;
    std::vector<float> positions;
    gim_status status = GIM_BAD_ARGUMENT;
};

Decoded decode(const std::vector<uint8_t>& bytes, uint32_t image, uint32_t level) {
    Decoded d;
    Decoder decoder;
    d.status = decoder.open(bytes);
    if (d.status != GIM_OK) return d;
    d.info = decoder.info();
    d.status = decoder.read_level(image, level, &d.level);
    if (d.status != GIM_OK) return d;
    d.positions.resize(size_t{d.level.side} * d.level.side * 3);
    d.status = decoder.grid(d.level, {d.positions, {}, {}, {}});
    return d;
}

TEST(WriteSquares, LosslessKeepsEveryQuantizedSampleAtEveryBitDepthAndSide) {
    for (const uint32_t side : {3u, 5u, 9u, 17u, 65u}) {
        for (const uint32_t bits : {8u, 12u, 16u, 20u}) {
            const SquareImage image = bumpy(side, side + bits);
            CodingParameters p;
            p.bits = bits;
            const auto bytes = write_squares({&image, 1}, p);
            ASSERT_TRUE(bytes.ok());
            const Decoded d = decode(bytes.value(), 0, 0);
            ASSERT_EQ(d.status, GIM_OK);
            for (size_t i = 0; i < image.positions.size(); ++i) {
                for (int k = 0; k < 3; ++k) {
                    const double unit = (image.positions[i][k] - d.info.origin[k]) / double{d.info.step};
                    const float q = static_cast<float>(std::max(std::floor(unit + 0.5), 0.0));
                    ASSERT_EQ(d.positions[i * 3 + static_cast<size_t>(k)],
                              static_cast<float>(d.info.origin[k]) + d.info.step * q)
                        << side << " " << bits << " sample " << i;
                }
            }
        }
    }
}

TEST(WriteSquares, LosslessIsWithinHalfAStep) {
    const SquareImage image = bumpy(65, 3);
    const Decoded d = decode(write_squares({&image, 1}, {}).value(), 0, 0);
    for (size_t i = 0; i < image.positions.size(); ++i)
        for (int k = 0; k < 3; ++k)
            EXPECT_LE(std::abs(double{d.positions[i * 3 + size_t(k)]} - image.positions[i][k]),
                      0.5001 * double{d.info.step});
}

TEST(WriteSquares, FinerQuantizersComeCloserAndTakeMore) {
    const SquareImage image = bumpy(129, 4, {17, 8, {{1, 32}, {0, 32}}});
    CodingParameters p;
    p.lossless = false;
    double last_error = 1e9;
    size_t last_size = 0;
    for (const double quantizer : {64.0, 16.0, 4.0, 1.0, 0.25}) {
        p.quantizer = quantizer;
        const auto bytes = write_squares({&image, 1}, p).value();
        const Decoded d = decode(bytes, 0, 0);
        ASSERT_EQ(d.status, GIM_OK);
        double error = 0;
        for (size_t i = 0; i < image.positions.size(); ++i)
            for (int k = 0; k < 3; ++k)
                error += std::pow(double{d.positions[i * 3 + size_t(k)]} - image.positions[i][k], 2);
        EXPECT_LT(error, last_error);
        EXPECT_GT(bytes.size(), last_size);
        // The steps of unit-norm coefficients, one along the normal and two along the surface, bound the error of each.
        const double steps = quantizer * std::sqrt((1 + 2 * kTangentialRatio * kTangentialRatio) / 3);
        EXPECT_LT(std::sqrt(error / double(image.positions.size())), steps * double{d.info.step});
        last_error = error;
        last_size = bytes.size();
    }
}

TEST(WriteSquares, SeveralImagesOfSeveralSidesEachDecodeAsIfAlone) {
    const std::vector<SquareImage> images = {bumpy(65, 1, {17, 8, {{1, 32}, {0, 32}}}), bumpy(9, 2),
                                             bumpy(129, 3, {5, 0, {{2, 4}, {3, 4}, {0, 4}, {1, 4}}})};
    for (const bool lossless : {true, false}) {
        CodingParameters p;
        p.lossless = lossless;
        p.quantizer = 2;
        const auto bytes = write_squares(images, p).value();
        for (uint32_t i = 0; i < images.size(); ++i) {
            const Decoded d = decode(bytes, i, 0);
            ASSERT_EQ(d.status, GIM_OK) << i;
            EXPECT_EQ(d.level.side, images[i].side());
            for (size_t s = 0; s < images[i].positions.size(); ++s)
                for (int k = 0; k < 3; ++k)
                    ASSERT_NEAR(d.positions[s * 3 + size_t(k)], images[i].positions[s][k], 8 * d.info.step);
            for (uint32_t level = 0; level <= d.level.coarsest_level; ++level)
                EXPECT_EQ(decode(bytes, i, level).status, GIM_OK);
            EXPECT_EQ(decode(bytes, i, d.level.coarsest_level + 1).status, GIM_NO_SUCH_LEVEL);
        }
    }
}

TEST(WriteSquares, EveryLevelDecodesFromItsPrefixAlone) {
    const SquareImage image = bumpy(129, 5, {17, 8, {{1, 32}, {0, 32}}});
    const auto bytes = write_squares({&image, 1}, {}).value();
    for (uint32_t level = 0; level <= 3; ++level) {
        const Decoded whole = decode(bytes, 0, level);
        ASSERT_EQ(whole.status, GIM_OK);
        std::vector<uint8_t> prefix(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(whole.level.prefix_size));
        EXPECT_EQ(decode(prefix, 0, level).positions, whole.positions);
        prefix.pop_back();
        EXPECT_EQ(decode(prefix, 0, level).status, GIM_NEED_MORE_INPUT);
    }
}

TEST(WriteSquares, CoarserLevelsAreUsableImages) {
    const SquareImage image = bumpy(129, 6);
    for (const bool lossless : {true, false}) {
        CodingParameters p;
        p.lossless = lossless;
        p.quantizer = 1;
        const auto bytes = write_squares({&image, 1}, p).value();
        for (uint32_t level = 1; level <= 2; ++level) {
            const Decoded d = decode(bytes, 0, level);
            ASSERT_EQ(d.status, GIM_OK);
            for (uint32_t r = 0; r < d.level.side; ++r)
                for (uint32_t c = 0; c < d.level.side; ++c) {
                    const Vec3& x = image.at(r << level, c << level);
                    for (int k = 0; k < 3; ++k)
                        ASSERT_NEAR(d.positions[(size_t{r} * d.level.side + c) * 3 + size_t(k)], x[k], 0.05);
                }
        }
    }
}

// Cut-nodes on a grid of 9 x 9. Smaller images cannot be closed and would only cost bytes.
TEST(WriteSquares, LevelsThatNoImageCanCloseAreLeftOut) {
    CodingParameters parameters;
    parameters.base_side = 3;
    const SquareImage fine = bumpy(33, 1, {9, 0, {{2, 7}, {3, 9}, {0, 7}, {1, 9}}});
    const SquareImage coarse = bumpy(33, 1, {5, 0, {{2, 3}, {3, 5}, {0, 3}, {1, 5}}});
    const auto level_count = [&](std::span<const SquareImage> images) {
        gim_info info;
        const auto bytes = write_squares(images, parameters).value();
        EXPECT_EQ(gim_read_info(bytes.data(), bytes.size(), nullptr, &info), GIM_OK);
        return info.level_count;
    };
    EXPECT_EQ(level_count({&fine, 1}), 3u);
    EXPECT_EQ(level_count({&coarse, 1}), 4u);
    const std::vector<SquareImage> both{fine, coarse};
    EXPECT_EQ(level_count(both), 4u);
}

TEST(WriteSquares, OverheadIsSmall) {
    const SquareImage image = bumpy(257, 7, {17, 8, {{1, 32}, {0, 32}}});
    CodingParameters p;
    p.lossless = false;
    p.quantizer = 1e4;
    const Decoded d = decode(write_squares({&image, 1}, p).value(), 0, 0);
    EXPECT_LE(d.info.index_size + 10, 80u);
}

TEST(WriteSquares, TextIsPackedWhereThatIsSmaller) {
    const SquareImage image = bumpy(9, 8);
    CodingParameters p;
    p.text = std::string(1000, 'a');
    const auto bytes = write_squares({&image, 1}, p).value();
    gim_info info;
    ASSERT_EQ(gim_read_info(bytes.data(), bytes.size(), nullptr, &info), GIM_OK);
    gim_chunk chunk;
    ASSERT_EQ(gim_read_chunk(&info, bytes.data(), bytes.size(), info.chunk_count - 1, &chunk), GIM_OK);
    EXPECT_STREQ(chunk.name, "META");
    EXPECT_EQ(chunk.raw_size, 1000u);
    EXPECT_LT(chunk.size, 100u);
    EXPECT_EQ(chunk.intact, 1u);
    EXPECT_EQ(decode(bytes, 0, 0).status, GIM_OK);
}

TEST(WriteSquares, BadImagesAreRefusedWithWords) {
    SquareImage image = bumpy(9, 9);
    EXPECT_FALSE(write_squares({}, {}).ok());
    image.positions[12].y() = NAN;
    EXPECT_NE(write_squares({&image, 1}, {}).error().message.find("row 1, column 3"), std::string::npos);
    image = bumpy(9, 9);
    image.sideband = {9, 8, {{1, 16}, {0, 16}}};  // leaves on corners
    EXPECT_FALSE(write_squares({&image, 1}, {}).ok());
    image.sideband = {9, 8, {{1, 15}, {0, 16}}};
    EXPECT_FALSE(write_squares({&image, 1}, {}).ok());
    image = bumpy(9, 9);
    image.positions.pop_back();
    EXPECT_FALSE(write_squares({&image, 1}, {}).ok());
    image = bumpy(9, 9);
    CodingParameters p;
    p.bits = 21;
    EXPECT_FALSE(write_squares({&image, 1}, p).ok());
}

TEST(WriteSquares, ASurfaceWithoutExtentCodes) {
    const SquareImage image = glue_square({5, std::vector<Vec3>(25, Vec3(1, -2, 3e6))}, {}).value();
    for (const bool lossless : {true, false}) {
        CodingParameters p;
        p.lossless = lossless;
        const Decoded d = decode(write_squares({&image, 1}, p).value(), 0, 0);
        ASSERT_EQ(d.status, GIM_OK);
        for (size_t i = 0; i < 25; ++i) EXPECT_FLOAT_EQ(d.positions[i * 3 + 2], 3e6f);
    }
}

}  // namespace
}  // namespace gim

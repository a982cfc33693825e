#include "encoder/code/code_bands.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "encoder/code/file_units.h"
#include "encoder/squares/write_squares.h"
#include "gim/decoder.hpp"
#include "tests/encoder/coding_parameters.h"
#include "tests/encoder/grid_images.h"
#include "tests/format/random_sideband.h"

namespace gim {
namespace {

using test::lossy;

constexpr uint32_t kSide = 129;

// A wavy sheet, wavier on one side. Nothing is glued, so decoders fuse nothing.
SquareImage waves() {
    return image_of(kSide, open_sideband(), [](double u, double v) {
        return Vec3(u + 0.1 * u * u, v + 0.05 * std::sin(5 * u), 0.1 * std::sin(17 * u * u) * std::cos(9 * v));
    });
}

SeamTable seams_of(const SquareImage& image) {
    SeamTable seams;
    EXPECT_EQ(build_seam_table(image.sideband, &seams), Status::kOk);
    return seams;
}

Pyramid<float> pyramid_of(const SquareImage& image, const Units& header) {
    const SeamTable seams = seams_of(image);
    Pyramid<float> pyramid = analyse<Irreversible97>(to_units<float>(image.positions, header), image.side(), &seams);
    subtract_middle(&pyramid, header.bits);
    return pyramid;
}

std::vector<float> decoded_units(const std::vector<uint8_t>& bytes) {
    Decoder decoder;
    DecoderLevel level;
    EXPECT_EQ(decoder.open(bytes), GIM_OK);
    EXPECT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
    std::vector<float> positions(3 * size_t{kSide} * kSide);
    EXPECT_EQ(decoder.grid(level, {positions, {}, {}, {}}), GIM_OK);
    const gim_info& info = decoder.info();
    for (size_t i = 0; i < positions.size(); ++i)
        positions[i] = static_cast<float>((double{positions[i]} - info.origin[i % 3]) / double{info.step});
    return positions;
}

TEST(CodeBands, QuantizedImageIsWhatADecoderMakes) {
    for (const SquareImage& image : {waves(), torus_image(kSide, 700, 300)})
        for (const double quantizer : {1.0, 8.0, 60.0, 500.0}) {
            const SeamTable seams = seams_of(image);
            const auto made = squares_writer({&image, 1}, lossy(quantizer));
            const FileWriter& writer = made.value();
            const Header header = writer.header(quantizer);
            ASSERT_GT(header.tangential, 0);
            ASSERT_GT(header.cell_area, 1);
            const std::vector<float> expected =
                quantize_bands(pyramid_of(image, header), detail_coding_of(header), &seams).image;
            const std::vector<float> decoded = decoded_units(writer.write(quantizer));
            const float middle = static_cast<float>(1 << (header.bits - 1));
            ASSERT_EQ(expected.size(), decoded.size());
            // A decoder rounds values around 2^(bits-1), not 0. That turns frames by some 1e-5.
            for (size_t i = 0; i < decoded.size(); ++i)
                ASSERT_NEAR(expected[i] + middle, decoded[i], 0.02f) << quantizer;
        }
}

// Returns the images on the way. The last one must be the quantizer's own.
std::vector<std::vector<float>> expect_same_image(const Pyramid<float>& pyramid, const DetailCoding& coding,
                                                  const SeamTable* seams) {
    const QuantizedImage quantized = quantize_bands(pyramid, coding, seams);
    std::vector<std::vector<float>> images = decode_bands(quantized.bands, coding, seams);
    EXPECT_EQ(images.size(), size_t{pyramid.steps()} + 1);
    EXPECT_EQ(images.back(), quantized.image);
    return images;
}

TEST(CodeBands, DecodedBandsAreTheQuantizersImageBitForBit) {
    for (const SquareImage& image : {waves(), torus_image(kSide, 700, 300)}) {
        for (const double quantizer : {1.0, 8.0, 60.0, 500.0}) {
            const SeamTable seams = seams_of(image);
            const Header header = squares_writer({&image, 1}, lossy(1)).value().header(quantizer);
            const auto images = expect_same_image(pyramid_of(image, header), detail_coding_of(header), &seams);
            for (size_t step = 0; step < images.size(); ++step) {
                const size_t side = step == 0 ? 2 : (size_t{1} << step) + 1;
                EXPECT_EQ(images[step].size(), 3 * side * side);
            }
        }
    }
}

std::vector<float> random_image(test::Random& random, size_t samples) {
    std::vector<float> image;
    for (size_t i = 0; i < 3 * samples; ++i) image.push_back(100 * (random.unit() - 0.5f));
    return image;
}

TEST(CodeBands, SharedDetailsAreDecodedFromTheirSourcesOnly) {
    test::Random random(3);
    const uint32_t side = 33;
    const DetailCoding coding{3, true, 3, 400};
    for (int round = 0; round < 20; ++round) {
        SeamTable seams;
        const Sideband sideband = test::random_sideband(random, 9, 1 + random.below(12), random.below(8), false);
        ASSERT_EQ(build_seam_table(sideband, &seams), Status::kOk);
        const Pyramid<float> pyramid = analyse<Irreversible97>(random_image(random, size_t{side} * side), side, &seams);
        const std::vector<float> image = expect_same_image(pyramid, coding, &seams).back();
        Pyramid<int32_t> bands = quantize_bands(pyramid, coding, &seams).bands;
        for (uint32_t step = 1; step <= bands.steps(); ++step) {
            const OwnSharedRim rim(&seams, bands.columns_at(step));
            rim.view().for_each_copy([&](Orientation orientation, uint32_t row, uint32_t column) {
                bands_of(bands, step - 1).of(orientation).row(row)[3 * column] = 99;
            });
        }
        EXPECT_EQ(decode_bands(bands, coding, &seams).back(), image);
    }
}

TEST(CodeBands, RectanglesWithoutSeamsDecodeToTheQuantizersImageToo) {
    test::Random random(4);
    for (const auto& [columns, rows, steps] :
         {std::array{75u, 46u, 4u}, std::array{2u, 30u, 0u}, std::array{9u, 5u, 2u}}) {
        const Pyramid<float> pyramid =
            analyse<Irreversible97>(random_image(random, size_t{columns} * rows), columns, rows, steps);
        expect_same_image(pyramid, {5, true, 3, 900}, nullptr);
    }
}

TEST(CodeBands, FineSteppedDetailsComeBackThroughTheirFrames) {
    const SquareImage image = waves();
    const Header header = squares_writer({&image, 1}, lossy(1)).value().header(0.125);
    const Pyramid<float> pyramid = pyramid_of(image, header);
    const SeamTable seams = seams_of(image);
    const std::vector<float> before = restore<Irreversible97>(pyramid, &seams),
                             after = quantize_bands(pyramid, detail_coding_of(header), &seams).image;
    double squares = 0;
    for (size_t i = 0; i < before.size(); ++i) squares += std::pow(double{before[i]} - after[i], 2);
    EXPECT_LT(std::sqrt(squares / double(before.size())), 0.125);
}

TEST(CodeBands, WithoutFramesNoImageIsMade) {
    const SquareImage image = waves();
    const Header header = squares_writer({&image, 1}, lossy(1)).value().header(8);
    const Pyramid<float> pyramid = pyramid_of(image, header);
    const QuantizedImage plain = quantize_bands(pyramid, {8}), framed = quantize_bands(pyramid, {8, true, 3, 1});
    EXPECT_TRUE(plain.image.empty());
    EXPECT_EQ(framed.image.size(), 3 * size_t{kSide} * kSide);
    EXPECT_EQ(plain.bands.base, framed.bands.base);
    EXPECT_NE(plain.bands.levels.back().horizontal, framed.bands.levels.back().horizontal);
}

TEST(CodeBands, WiderTangentialStepsKeepLessOfTheTangentialDetail) {
    const SquareImage image = waves();
    const Header header = squares_writer({&image, 1}, lossy(1)).value().header(8);
    const Pyramid<float> pyramid = pyramid_of(image, header);
    const auto sum = [&](float tangential, bool normal) {
        const QuantizedImage quantized = quantize_bands(pyramid, {8, true, tangential, 1});
        uint64_t all = 0;
        for (const auto& level : quantized.bands.levels) {
            for (const auto* band : {&level.horizontal, &level.vertical, &level.diagonal}) {
                for (size_t i = 0; i < band->size(); ++i) {
                    if ((i % 3 == 0) == normal) all += magnitude_of((*band)[i]);
                }
            }
        }
        return double(all);
    };
    EXPECT_LT(sum(4, false), 0.4 * sum(1, false));
    EXPECT_NEAR(sum(4, true) / sum(1, true), 1, 0.1);
}

TEST(CodeBands, CellAreaIsTheMeanOfTheCells) {
    // Cells of 3 x 2 object units; 1 x 2 where the mask leaves them out.
    std::vector<Vec3> positions;
    std::vector<uint8_t> defined;
    for (uint32_t row = 0; row < 5; ++row) {
        for (uint32_t column = 0; column < 9; ++column) {
            positions.emplace_back(column < 5 ? 3.0 * column : 12.0 + column - 4, 2.0 * row, 0);
            defined.push_back(column < 5);
        }
    }
    Header header;
    header.step = 0.5f;
    CellArea area;
    area.add(positions, defined, 9, 5);
    area.set_details(&header);
    EXPECT_EQ(header.tangential, 8 * kTangentialRatio);
    EXPECT_EQ(cell_area_of(header.cell_area), 24.0f);  // 6 / 0.5^2
    CellArea all;
    all.add(positions, {}, 9, 5);
    all.set_details(&header);
    EXPECT_EQ(cell_area_of(header.cell_area), 16.0f);
}

}  // namespace
}  // namespace gim

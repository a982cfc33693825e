#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "gim/decoder.hpp"
#include "tests/encoder/raster/made_rasters.h"

namespace gim {
namespace {

using namespace gim::test;

EncodeOptions options_of(RateTarget rate) {
    EncodeOptions options;
    options.rate = rate;
    options.threads = 1;
    return options;
}
const EncodeOptions kExact = options_of({RateTarget::Kind::kLossless, 0});

Encoded encoded(const RasterImage& image, const EncodeOptions& options = kExact) {
    Result<Encoded> file = encode_raster(image, options);
    EXPECT_TRUE(file.ok()) << file.error().message;
    return file.ok() ? std::move(file.value()) : Encoded{};
}

std::string failure(const RasterImage& image, const EncodeOptions& options = kExact) {
    const Result<Encoded> file = encode_raster(image, options);
    return file.ok() ? "" : file.error().message;
}

struct Back {
    std::vector<double> values;
    std::vector<uint8_t> defined;
};

Back decoded(const std::vector<uint8_t>& file) {
    Decoder decoder;
    gim_raster_info info;
    EXPECT_EQ(decoder.open(file), GIM_OK);
    EXPECT_EQ(gim_read_raster_info(&decoder.info(), file.data(), file.size(), &info), GIM_OK);
    Back back;
    back.defined.resize(size_t{info.width} * info.height);
    std::vector<int32_t> numbers(back.defined.size() * info.channels);
    Scratch scratch(info.scratch_size);
    EXPECT_EQ(gim_decode_raster(&decoder.info(), file.data(), file.size(), numbers.data(), back.defined.data(),
                                scratch.data(), scratch.size()),
              GIM_OK);
    for (size_t i = 0; i < numbers.size(); ++i) {
        gim_raster_channel c;
        EXPECT_EQ(gim_read_raster_channel(&decoder.info(), file.data(), file.size(),
                                          static_cast<uint32_t>(i % info.channels), &c),
                  GIM_OK);
        back.values.push_back(back.defined[i / info.channels] ? c.origin + c.step * numbers[i] : 0);
    }
    return back;
}

void expect_exact(const RasterImage& image, const EncodeOptions& options = kExact) {
    const Back back = decoded(encoded(image, options).bytes);
    EXPECT_EQ(back.defined, image.defined);
    EXPECT_EQ(back.values, image.values);
}

TopologySummary topology_of(const std::vector<uint8_t>& file) {
    Decoder decoder;
    DecoderLevel level;
    EXPECT_EQ(decoder.open(file), GIM_OK);
    EXPECT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
    std::vector<float> positions(size_t{level.vertex_count} * 3);
    std::vector<uint32_t> triangles(size_t{level.triangle_count} * 3);
    EXPECT_EQ(decoder.mesh(level, {positions, {}, {}, triangles}), GIM_OK);
    TriangleMesh mesh;
    for (size_t v = 0; v < positions.size(); v += 3)
        mesh.positions.push_back({positions[v], positions[v + 1], positions[v + 2]});
    for (size_t t = 0; t < triangles.size(); t += 3)
        mesh.triangles.push_back({triangles[t], triangles[t + 1], triangles[t + 2]});
    return summarize_topology(mesh);
}

TEST(EncodeRaster, WholeNumbersAreExactUnderEveryMask) {
    const MaskRule masks[] = {all_defined,
                              with_holes,
                              [](uint32_t r, uint32_t c) { return (r + c) % 7 < 4; },
                              [](uint32_t r, uint32_t c) { return r * r + c * c < 200; },
                              [](uint32_t r, uint32_t c) { return r < 2 && c < 2 && r + c < 2; },
                              [](uint32_t r, uint32_t c) { return r > 1 && c > 20; }};
    for (const MaskRule mask : masks) {
        SCOPED_TRACE(&mask - masks);
        expect_exact(raster_of(31, 23, mask, 3));
    }
    expect_exact(raster_of(2, 40, all_defined, 3));
    expect_exact(raster_of(40, 2, all_defined, 3));
}

TEST(EncodeRaster, OtherChannelsAreExactToo) {
    for (const uint32_t channels : {4u, 5u, 6u, 10u}) expect_exact(raster_of(20, 15, with_holes, channels));
    RasterImage image = raster_of(20, 15, with_holes, 4);
    for (size_t i = 3; i < image.values.size(); i += 4) image.values[i] = image.defined[i / 4] ? 7 : 0;
    expect_exact(image);
    const Encoded lossy = encoded(image, options_of({RateTarget::Kind::kQuality, 40}));
    const Back back = decoded(lossy.bytes);
    for (size_t i = 3; i < image.values.size(); i += 4) EXPECT_EQ(back.values[i], image.values[i]);
}

TEST(EncodeRaster, NegativeAndLargeNumbersAreExact) {
    RasterImage image = raster_of(20, 15, with_holes, 3);
    image.type = SampleType::kInt32;
    for (size_t i = 0; i < image.values.size(); ++i)
        if (image.defined[i / 3]) image.values[i] = image.values[i] * 200 - 2e9;
    expect_exact(image);
    for (double& v : image.values) v *= 8;
    EXPECT_NE(failure(image).find("more than 20 bits"), std::string::npos);
}

TEST(EncodeRaster, FloatsAreRoundedToTheBits) {
    RasterImage image = raster_of(30, 20, with_holes, 5);
    image.type = SampleType::kFloat32;
    for (double& v : image.values) v = std::sin(v * 0.001);
    for (const uint32_t bits : {10u, 16u, 20u}) {
        EncodeOptions options = kExact;
        options.bits = bits;
        const Encoded file = encoded(image, options);
        const Back back = decoded(file.bytes);
        const double half = 1.001 * 2 / (std::exp2(bits) - 1) / 2;
        for (size_t i = 0; i < image.values.size(); ++i) {
            if (!image.defined[i / 5]) continue;
            EXPECT_NEAR(back.values[i], image.values[i], half + 1e-6);
        }
        EXPECT_EQ(encoded(image, options).bytes, file.bytes);
    }
}

TEST(EncodeRaster, BordersThatCoincideAreGlued) {
    const RasterImage image = folded_raster(24, 10, 0);
    const Encoded file = encoded(image);
    const TopologySummary topology = topology_of(file.bytes);
    EXPECT_TRUE(topology.manifold);
    EXPECT_EQ(topology.boundary_loops, 2u);  // the ends of the tube
    EXPECT_EQ(topology.components, 1u);
    EXPECT_EQ(file.report.charts, 2u);
    EXPECT_EQ(file.report.border_samples, 4u * 24 + 4 * 8);
    EXPECT_EQ(file.report.open_samples, 4u * 8);
    // Both sides stay together if the positions get coarser.
    const TopologySummary coarse = topology_of(encoded(image, options_of({RateTarget::Kind::kQuality, 60})).bytes);
    EXPECT_EQ(coarse.boundary_loops, 2u);
    EXPECT_TRUE(coarse.manifold);
}

// Each chart is a component of the decoded surface, where no borders coincide.
TEST(EncodeRaster, PiecesThatTouchAtCornersAreCharts) {
    const auto charts = [](MaskRule mask) {
        const Encoded file = encoded(raster_of(24, 16, mask, 3));
        EXPECT_EQ(file.report.charts, topology_of(file.bytes).components);
        return file.report.charts;
    };
    EXPECT_EQ(charts([](uint32_t r, uint32_t c) { return (r < 8) == (c < 12); }), 2u);
    EXPECT_EQ(charts([](uint32_t r, uint32_t c) { return r / 4 % 2 == c / 4 % 2; }), 12u);
    EXPECT_EQ(charts([](uint32_t r, uint32_t c) { return r + 3 < c || r > c; }), 2u);
    EXPECT_EQ(charts([](uint32_t r, uint32_t c) { return (r < 9 && c < 13) || (r > 7 && c > 11); }), 1u);
}

TEST(EncodeRaster, BordersWithinTheToleranceAreGluedAndStayExact) {
    const RasterImage image = folded_raster(24, 10, 2);
    EXPECT_EQ(encoded(image).report.open_samples, 4u * 8 + 4 * 12);
    EncodeOptions options = kExact;
    options.weld_tolerance = Length{2.5, false};
    const Encoded file = encoded(image, options);
    EXPECT_EQ(file.report.open_samples, 4u * 8);
    EXPECT_EQ(topology_of(file.bytes).boundary_loops, 2u);
    expect_exact(image, options);
}

// Two pieces side by side, of 9 columns, with other numbers of rows. They share the border at x = 0, which bends. The right
// one may be turned by half a turn.
RasterImage two_spacings(uint32_t left_rows, uint32_t right_rows, double bend, double uneven, bool is_turned = false) {
    RasterImage image;
    image.width = 19;
    image.height = std::max(left_rows, right_rows);
    image.type = SampleType::kFloat64;
    image.mask = RasterImage::Mask::kArray;
    for (uint32_t r = 0; r < image.height; ++r) {
        for (uint32_t c = 0; c < image.width; ++c) {
            const uint32_t rows = c < 9 ? left_rows : right_rows;
            const bool is_defined = c != 9 && r < rows;
            const double x = c < 9 ? (double(c) - 8) / 8 : is_turned ? (18 - double(c)) / 8 : (double(c) - 10) / 8;
            double y = double(is_turned && c > 9 ? rows - 1 - r : r) / (rows - 1);
            if (c < 9) y += uneven * std::sin(6 * y) * y * (1 - y);
            image.defined.push_back(is_defined ? 1 : 0);
            for (const double v : {x, 10 * y, bend * std::sin(5 * y) + 0.2 * x * x})
                image.values.push_back(is_defined ? v : 0);
        }
    }
    return image;
}

TEST(EncodeRaster, BordersOfOtherSpacingAreZippered) {
    const auto expect_one_piece = [](const RasterImage& image, const EncodeOptions& options) {
        const Encoded file = encoded(image, options);
        const TopologySummary topology = topology_of(file.bytes);
        EXPECT_TRUE(topology.manifold);
        EXPECT_EQ(topology.components, 1u);
        EXPECT_EQ(topology.boundary_loops, 1u);
        EXPECT_EQ(file.report.charts, 2u);
        const uint64_t rim = file.report.border_samples - 2 * 9 - 2 * 9;  // without the short sides
        EXPECT_LE(file.report.open_samples, rim / 2 + 4 * 8);
        EncodeOptions apart = options;
        apart.weld_tolerance = Length{0, false};
        const Encoded open = encoded(image, apart);
        EXPECT_EQ(decoded(file.bytes).values, decoded(open.bytes).values);
        EXPECT_GT(topology_of(open.bytes).components, 1u);
    };
    EncodeOptions near = kExact;
    near.weld_tolerance = Length{0.05, false};
    near.bits = 18;
    for (const auto& [left, right] : {std::pair{13u, 25u}, {25u, 13u}, {13u, 19u}, {19u, 14u}, {12u, 40u}}) {
        SCOPED_TRACE(std::to_string(left) + " and " + std::to_string(right));
        expect_one_piece(two_spacings(left, right, 0, 0), kExact);
        expect_one_piece(two_spacings(left, right, 0.4, 0), near);
        expect_one_piece(two_spacings(left, right, 0.4, 0.3), near);
        expect_one_piece(two_spacings(left, right, 0.4, 0.3, true), near);
    }
    expect_one_piece(two_spacings(15, 15, 0.4, 0.3), near);
}

TEST(EncodeRaster, BordersThatOnlyComeNearStayOpen) {
    RasterImage image = two_spacings(13, 19, 0, 0);
    for (size_t i = 0; i < image.defined.size(); ++i)
        if (i % image.width > 9) image.values[3 * i] += 0.06;
    EncodeOptions options = kExact;
    options.weld_tolerance = Length{0.05, false};
    EXPECT_EQ(topology_of(encoded(image, options).bytes).components, 2u);
}

TEST(EncodeRaster, GluedBordersAreNearlyFree) {
    const size_t glued = encoded(folded_raster(60, 6, 0)).bytes.size();
    RasterImage apart = folded_raster(60, 6, 0);
    for (size_t i = 0; i < apart.values.size(); i += 3)
        if (i / 3 >= 60 * 7) apart.values[i] += 3000;
    EXPECT_LT(glued + 60, encoded(apart).bytes.size());
}

TEST(EncodeRaster, TargetsAreMet) {
    RasterImage image = folded_raster(40, 20, 0);
    image.type = SampleType::kFloat32;
    for (double& v : image.values) v = v / 7 + 0.01;
    size_t last = 0;
    for (const double psnr : {48.0, 60.0}) {
        const Encoded file = encoded(image, options_of({RateTarget::Kind::kPsnr, psnr}));
        EXPECT_GE(file.report.error.psnr, psnr);
        EXPECT_LT(file.report.error.psnr, psnr + 3);
        EXPECT_GT(file.bytes.size(), last);
        last = file.bytes.size();
    }
    const Encoded near = encoded(image, options_of({RateTarget::Kind::kMaxError, 0.01, true}));
    EXPECT_LE(near.report.error.hausdorff, 0.01 * near.report.error.diagonal);
    for (const double bytes : {900.0, 1600.0}) {
        const size_t size = encoded(image, options_of({RateTarget::Kind::kBytes, bytes})).bytes.size();
        EXPECT_LE(double(size), bytes);
        EXPECT_GT(double(size), 0.8 * bytes);
    }
    EXPECT_NE(failure(image, options_of({RateTarget::Kind::kBytes, 60})).find("the smallest file"), std::string::npos);
    EXPECT_NE(failure(image, options_of({RateTarget::Kind::kPsnr, 190})).find("--bits"), std::string::npos);
}

TEST(EncodeRaster, WhatIsNoImageOfASurfaceIsRefused) {
    RasterImage image = raster_of(10, 10, all_defined, 3);
    image.defined.assign(100, 0);
    EXPECT_NE(failure(image).find("defines no sample"), std::string::npos);
    for (const size_t i : {5u, 17u, 38u}) image.defined[i] = 1;
    EXPECT_NE(failure(image).find("no surface"), std::string::npos);
    image = raster_of(10, 10, all_defined, 3);
    image.values[3 * 42 + 1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(failure(image).find("row 4, column 2"), std::string::npos);
    image.defined[42] = 0;
    EXPECT_EQ(failure(image), "");
    image.values.pop_back();
    EXPECT_NE(failure(image).find("not as many values"), std::string::npos);
    EXPECT_NE(failure(raster_of(10, 10, all_defined, 2)).find("3 to 4096 channels"), std::string::npos);
}

TEST(EncodeRaster, TheFixedCostIsSmall) {
    const Encoded file = encoded(raster_of(64, 64, with_holes, 3));
    Decoder decoder;
    ASSERT_EQ(decoder.open(file.bytes), GIM_OK);
    EXPECT_LE(decoder.info().index_size + file.report.sideband_bytes, 60u);
}

}  // namespace
}  // namespace gim

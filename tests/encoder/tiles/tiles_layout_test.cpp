// Tiles from the mesh to the file and back.
#include <gtest/gtest.h>

#include <string>

#include "corpus/corpus.h"
#include "corpus/generators.h"
#include "gim/encoder.h"
#include "tests/encoder/decoded_topology.h"

namespace gim {
namespace {

EncodeOptions tiles(uint32_t count, RateTarget rate) {
    EncodeOptions options;
    options.layout = Layout::kTiles;
    options.tiles = count;
    options.samples = 20000;
    options.rate = rate;
    return options;
}

const RateTarget kLossless = {RateTarget::Kind::kLossless, 0};

TEST(TilesLayout, EverySurfaceComesBackWithItsTopologyAtEveryLevel) {
    for (const corpus::CorpusEntry& entry : corpus::corpus().valid()) {
        const auto encoded = encode(entry.mesh(), tiles(60, kLossless));
        ASSERT_TRUE(encoded.ok()) << entry.name << ": " << encoded.error().message;
        EXPECT_EQ(encoded.value().report.layout, Layout::kTiles);
        EXPECT_GT(encoded.value().report.error.psnr, 45) << entry.name;
        for (const LevelReport& level : encoded.value().report.levels)
            expect_topology(encoded.value(), level.level, entry.name);
    }
}

TEST(TilesLayout, AFitToTheQuantizerMeetsItsTarget) {
    const TriangleMesh mesh = corpus::roughened(corpus::torus(60, 30, 0.7, 0.3), 0.01, 1);
    const auto encoded = encode(mesh, tiles(40, {RateTarget::Kind::kPsnr, 58}));
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_GE(encoded.value().report.error.psnr, 58);
    EXPECT_LT(encoded.value().report.error.psnr, 58.5);
    const auto plain = [&] {
        EncodeOptions options = tiles(40, {RateTarget::Kind::kPsnr, 58});
        options.fit = FitStrength::kStiff;
        return encode(mesh, options);
    }();
    ASSERT_TRUE(plain.ok()) << plain.error().message;
    EXPECT_LT(encoded.value().bytes.size(), 0.9 * static_cast<double>(plain.value().bytes.size()));
    expect_topology(encoded.value(), 0, "torus");
}

TEST(TilesLayout, TheNumberOfTilesIsFoundByTrial) {
    const TriangleMesh mesh = corpus::limbed_blob(24);
    const RateTarget rate = {RateTarget::Kind::kPsnr, 55};
    const auto found = encode(mesh, tiles(0, rate)), usual = encode(mesh, tiles(120, rate));
    ASSERT_TRUE(found.ok()) << found.error().message;
    ASSERT_TRUE(usual.ok()) << usual.error().message;
    EXPECT_LE(found.value().bytes.size(), usual.value().bytes.size());
    EXPECT_GE(found.value().report.error.psnr, 55);
}

TEST(TilesLayout, BytesDoNotDependOnThreads) {
    EncodeOptions one = tiles(30, {RateTarget::Kind::kQuality, 60});
    EncodeOptions three = one;
    one.threads = 1;
    three.threads = 3;
    const TriangleMesh mesh = corpus::torus(48, 24, 0.7, 0.3);
    const auto a = encode(mesh, one), b = encode(mesh, three);
    ASSERT_TRUE(a.ok() && b.ok());
    EXPECT_EQ(a.value().bytes, b.value().bytes);
}

TEST(TilesLayout, NormalsAndColoursThatAreAskedForAreRefused) {
    EncodeOptions options = tiles(30, kLossless);
    options.normal_side = 65;
    EXPECT_FALSE(encode(corpus::sphere(4), options).ok());
    options.normal_side = 0;
    options.color_side = 65;
    EXPECT_FALSE(encode(corpus::sphere(4), options).ok());
    options.color_side = {};
    TriangleMesh colored = corpus::sphere(4);
    colored.appearance.corner_colors.assign(colored.triangles.size(), {});
    const auto encoded = encode(colored, options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_EQ(encoded.value().report.warnings.size(), 1U);
}

}  // namespace
}  // namespace gim

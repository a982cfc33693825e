// Tiles from the mesh to the file and back.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "corpus/corpus.h"
#include "corpus/generators.h"
#include "encoder/surface/mesh.h"
#include "gim/decoder.hpp"
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

TEST(TilesLayout, WithoutLossTilesFillTheSamples) {
    for (const TriangleMesh& mesh : {corpus::torus(60, 30, 0.7, 0.3), corpus::limbed_blob(24)}) {
        EncodeOptions options = tiles(0, kLossless);
        options.fit = FitStrength::kOff;
        options.density = false;
        const auto encoded = encode(mesh, options);
        ASSERT_TRUE(encoded.ok()) << encoded.error().message;
        const EncodeReport& report = encoded.value().report;
        const uint64_t atlas = uint64_t{report.width} * report.height;
        EXPECT_LE(atlas, 20000);
        EXPECT_GT(atlas, 0.85 * 20000);
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
    one.normal_side = 129;
    EncodeOptions three = one;
    one.threads = 1;
    three.threads = 3;
    const TriangleMesh mesh = corpus::torus(48, 24, 0.7, 0.3);
    const auto a = encode(mesh, one), b = encode(mesh, three);
    ASSERT_TRUE(a.ok() && b.ok());
    EXPECT_EQ(a.value().bytes, b.value().bytes);
}

// Red by x, green by y, blue by z.
std::array<float, 3> color_of(const std::array<double, 3>& p) {
    const auto level = [](double x) { return static_cast<float>(0.5 + 0.45 * std::clamp(x, -1.0, 1.0)); };
    return {level(p[0]), level(p[1]), level(p[2])};
}
TriangleMesh colored(TriangleMesh mesh) {
    for (const auto& t : mesh.triangles) {
        mesh.appearance.corner_colors.push_back(
            {color_of(mesh.positions[t[0]]), color_of(mesh.positions[t[1]]), color_of(mesh.positions[t[2]])});
    }
    return mesh;
}

struct Plane {
    DecoderPlane info;
    std::vector<float> values;
    // At texture coordinates of a vertex, to the nearest texel.
    const float* at(const float* uv) const {
        const auto column = static_cast<size_t>(std::lround(uv[0] * static_cast<float>(info.width - 1)));
        const auto row = static_cast<size_t>(std::lround(uv[1] * static_cast<float>(info.height - 1)));
        return &values[3 * (row * info.width + column)];
    }
};
Plane plane_of(Decoder& decoder, uint32_t kind, uint32_t level) {
    Plane plane;
    EXPECT_EQ(decoder.read_plane(0, kind, level, &plane.info), GIM_OK);
    plane.values.resize(size_t{plane.info.width} * plane.info.height * 3);
    EXPECT_EQ(decoder.plane(plane.info, plane.values), GIM_OK);
    return plane;
}

// The file's colours at the vertices of every level of the mesh, from every level of the plane.
void expect_colors(const std::vector<uint8_t>& file, double tolerance) {
    Decoder decoder;
    ASSERT_EQ(decoder.open(file), GIM_OK);
    const Plane finest = plane_of(decoder, GIM_PLANE_COLORS, 0);
    for (uint32_t fineness = 0; fineness <= finest.info.coarsest_level; ++fineness) {
        const Plane plane = plane_of(decoder, GIM_PLANE_COLORS, fineness);
        for (uint32_t l = 0; l < decoder.info().level_count; ++l) {
            DecoderLevel level;
            ASSERT_EQ(decoder.read_level(0, l, &level), GIM_OK);
            const size_t samples = size_t{level.width} * level.height;
            std::vector<float> positions(3 * samples), texcoords(2 * samples);
            ASSERT_EQ(decoder.grid(level, {positions, {}, texcoords, {}}), GIM_OK);
            double sum = 0;
            size_t count = 0;
            for (size_t i = 0; i < samples; ++i) {
                const float* p = &positions[3 * i];
                if (std::isnan(p[0])) continue;
                const std::array<float, 3> wanted = color_of({p[0], p[1], p[2]});
                const float* found = plane.at(&texcoords[2 * i]);
                for (size_t k = 0; k < 3; ++k) sum += std::abs(double{found[k]} - double{wanted[k]});
                ++count;
            }
            EXPECT_LT(sum / (3 * double(count)), tolerance * (1 << fineness) * (1 << l)) << fineness << ", " << l;
        }
    }
}

TEST(TilesLayout, ColoursComeBackAtEveryLevel) {
    EncodeOptions options = tiles(60, {RateTarget::Kind::kQuality, 85});
    options.samples = 4000;
    options.color_side = 257;
    options.fit = FitStrength::kStiff;
    for (const TriangleMesh& mesh : {corpus::sphere(16), corpus::torus(60, 30, 0.7, 0.3), corpus::terrain(24)}) {
        const auto encoded = encode(colored(mesh), options);
        ASSERT_TRUE(encoded.ok()) << encoded.error().message;
        EXPECT_TRUE(encoded.value().report.warnings.empty());
        ASSERT_EQ(encoded.value().report.planes.size(), 1U);
        EXPECT_GT(encoded.value().report.planes[0].psnr, 40);
        expect_colors(encoded.value().bytes, 0.01);
    }
}

TEST(TilesLayout, NormalsOfASphereAreWithinADegree) {
    EncodeOptions options = tiles(30, {RateTarget::Kind::kQuality, 80});
    options.normal_side = 257;
    options.fit = FitStrength::kStiff;
    const auto encoded = encode(corpus::sphere(24), options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    ASSERT_EQ(encoded.value().report.planes.size(), 1U);
    EXPECT_LT(encoded.value().report.planes[0].mean_angle, 1);
}

// Texels on an edge hold the mean of both sides, those beside it their own side.
TEST(TilesLayout, NormalsOfABoxAreSharpBesideItsEdges) {
    EncodeOptions options = tiles(12, {RateTarget::Kind::kQuality, 80});
    options.samples = 2000;
    options.normal_side = 257;
    const auto encoded = encode(corpus::box(6, 1, 1), options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    Decoder decoder;
    ASSERT_EQ(decoder.open(encoded.value().bytes), GIM_OK);
    const Plane plane = plane_of(decoder, GIM_PLANE_NORMALS, 0);
    DecoderLevel level;
    ASSERT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
    const size_t samples = size_t{level.width} * level.height;
    std::vector<float> positions(3 * samples), texcoords(2 * samples);
    std::vector<uint32_t> triangles(3 * size_t{level.triangle_count});
    ASSERT_EQ(decoder.grid(level, {positions, {}, texcoords, triangles}), GIM_OK);
    size_t same = 0;
    for (size_t i = 0; i < triangles.size(); i += 3) {
        Vec3 corner[3];
        float uv[2] = {0, 0};
        for (size_t k = 0; k < 3; ++k) {
            const float* p = &positions[3 * size_t{triangles[i + k]}];
            corner[k] = Vec3(p[0], p[1], p[2]);
            for (size_t x = 0; x < 2; ++x) uv[x] += texcoords[2 * size_t{triangles[i + k]} + x] / 3;
        }
        const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
        const float* found = plane.at(uv);
        same += normal.dot(Vec3(found[0], found[1], found[2])) > 0.99;
    }
    EXPECT_GT(double(same), 0.95 * double(level.triangle_count));
}

TEST(TilesLayout, AByteBudgetHoldsWithPlanes) {
    EncodeOptions options = tiles(30, {RateTarget::Kind::kBytes, 6000});
    options.samples = 4000;
    options.normal_side = 129;
    const auto encoded = encode(colored(corpus::sphere(16)), options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_LE(encoded.value().bytes.size(), 6000U);
    EXPECT_EQ(encoded.value().report.planes.size(), 2U);
}

TEST(TilesLayout, ColoursCanBeLeftOut) {
    EncodeOptions options = tiles(30, kLossless);
    options.color_side = 0;
    const auto without = encode(colored(corpus::sphere(4)), options), plain = encode(corpus::sphere(4), options);
    ASSERT_TRUE(without.ok() && plain.ok());
    EXPECT_EQ(without.value().bytes, plain.value().bytes);
}

}  // namespace
}  // namespace gim

#include "encoder/squares/import_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "encoder/code/decode_surface.h"
#include "encoder/squares/write_squares.h"
#include "format/ring.h"
#include "format/seam.h"

namespace gim {
namespace {

constexpr double kPi = 3.14159265358979323846;

// A sphere folded out of the square. The ring is glued to itself along a straight cut from ring sample a to its
// antipode. The square's inner squares become loops like circles of latitude that close around the cut.
SquareGrid folded_sphere(uint32_t side, uint32_t leaf) {
    SquareGrid image;
    image.side = side;
    image.positions.resize(size_t{side} * side);
    const double last = side - 1;
    for (uint32_t depth = 0; depth <= (side - 1) / 2; ++depth) {
        const uint32_t inner = side - 2 * depth;
        const uint32_t count = inner > 1 ? ring_length(inner) : 1;
        for (uint32_t k = 0; k < count; ++k) {
            const GridPoint p = inner > 1 ? ring_point(inner, k) : GridPoint{};
            // Ring position as an angle from the leaf, and how far towards the centre of the square.
            const double angle = 2 * kPi * (double(k) / count - double(leaf) / ring_length(side));
            const double inwards = 2 * depth / last;
            // The loop at `inwards` is a flat curve that goes from the doubled arc (rim) to a point (centre).
            const double tilt = kPi / 2 * (1 + std::cos(angle)) / 2 * (1 - inwards) * 2 - kPi / 2 * (1 - inwards);
            const double swing = std::sin(angle) * kPi / 2 * std::sin(kPi * inwards);
            Vec3 x(std::sin(tilt) * std::cos(swing), std::sin(swing), std::cos(tilt) * std::cos(swing));
            x.z() += 2 * inwards;  // not a true sphere: keeps loops apart
            image.at(p.row + depth, p.column + depth) = x;
        }
    }
    return image;
}

std::vector<float> planes_of(const SquareGrid& image) {
    std::vector<float> planes;
    for (int k = 0; k < 3; ++k)
        for (const Vec3& p : image.positions) planes.push_back(static_cast<float>(p[k]));
    return planes;
}

std::vector<float> read_planes(const std::string& name, uint32_t side) {
    std::vector<float> planes(size_t{side} * side * 3);
    std::ifstream file(std::string(GIM_MODELS_DIR) + "/../authors-gim/" + name, std::ios::binary);
    file.read(reinterpret_cast<char*>(planes.data()), static_cast<std::streamsize>(planes.size() * 4));
    if (!file) planes.clear();
    return planes;
}

TopologySummary decoded_topology(const SquareImage& image) {
    const auto bytes = write_squares({&image, 1}, {});
    EXPECT_TRUE(bytes.ok());
    const Mesh mesh = decode_surface(bytes.value(), 0).value();
    TriangleMesh plain;
    for (const Vec3& p : mesh.positions) plain.positions.push_back({p.x(), p.y(), p.z()});
    plain.triangles = mesh.triangles;
    return summarize_topology(plain);
}

TEST(ImportImage, FoldedRingIsClosedAndMatesAreWelded) {
    for (const uint32_t leaf : {3u, 20u, 50u}) {
        const SquareGrid folded = folded_sphere(17, leaf);
        const auto imported = import_image(planes_of(folded), 17, 1e-5);
        ASSERT_TRUE(imported.ok()) << imported.error().message;
        const SquareImage& image = imported.value();
        ASSERT_EQ(image.sideband.paths.size(), 2u);
        EXPECT_EQ(image.sideband.paths[0].mate, 1);
        SeamTable seams;
        ASSERT_EQ(build_seam_table(image.sideband, &seams), Status::kOk);
        std::vector<uint32_t> class_of(ring_length(17));
        ring_classes(seams, 17, class_of);
        for (uint32_t a = 0; a < 64; ++a) {
            for (uint32_t b = 0; b < a; ++b) {
                const GridPoint p = ring_point(17, a), q = ring_point(17, b);
                if (class_of[a] != class_of[b]) continue;
                EXPECT_EQ(image.at(p.row, p.column), image.at(q.row, q.column));
            }
        }
        EXPECT_TRUE(decoded_topology(image).watertight);
    }
}

TEST(ImportImage, NoisyMatesAreFoundWithinTheToleranceOnly) {
    SquareGrid folded = folded_sphere(17, 20);
    for (uint32_t k = 0; k < ring_length(17); ++k) {
        const GridPoint p = ring_point(17, k);
        folded.at(p.row, p.column).x() += 1e-4 * std::sin(12.9 * k);
    }
    EXPECT_EQ(import_image(planes_of(folded), 17, 1e-3).value().sideband.paths.size(), 2u);
    EXPECT_TRUE(import_image(planes_of(folded), 17, 1e-6).value().sideband.paths.empty());
}

TEST(ImportImage, OpenImageStaysOpen) {
    SquareGrid flat;
    flat.side = 9;
    for (uint32_t r = 0; r < 9; ++r)
        for (uint32_t c = 0; c < 9; ++c) flat.positions.emplace_back(c, r, 0.1 * r * c);
    const auto image = import_image(planes_of(flat), 9, 1e-6);
    ASSERT_TRUE(image.ok());
    EXPECT_TRUE(image.value().sideband.paths.empty());
    EXPECT_EQ(decoded_topology(image.value()).boundary_loops, 1u);
}

TEST(ImportImage, PartlyGluedCylinderHasTwoLoops) {
    SquareGrid tube;
    tube.side = 9;
    for (uint32_t r = 0; r < 9; ++r)
        for (uint32_t c = 0; c < 9; ++c) {
            const double angle = 2 * kPi * (c % 8) / 8;
            tube.positions.emplace_back(std::cos(angle), std::sin(angle), 0.3 * r);
        }
    const auto image = import_image(planes_of(tube), 9, 1e-5);
    ASSERT_TRUE(image.ok()) << image.error().message;
    const TopologySummary t = decoded_topology(image.value());
    EXPECT_EQ(t.boundary_loops, 2u);
    EXPECT_EQ(t.euler, 0);
    EXPECT_TRUE(t.manifold);
}

TEST(ImportImage, TorusIsFoundToBeOne) {
    SquareGrid torus;
    torus.side = 17;
    for (uint32_t r = 0; r < 17; ++r)
        for (uint32_t c = 0; c < 17; ++c) {
            const double u = 2 * kPi * (c % 16) / 16, v = 2 * kPi * (r % 16) / 16;
            torus.positions.emplace_back((2 + std::cos(v)) * std::cos(u), (2 + std::cos(v)) * std::sin(u), std::sin(v));
        }
    const auto image = import_image(planes_of(torus), 17, 1e-5);
    ASSERT_TRUE(image.ok()) << image.error().message;
    const TopologySummary t = decoded_topology(image.value());
    EXPECT_TRUE(t.watertight);
    EXPECT_EQ(t.euler, 0);
}

double decoded_volume(const SquareImage& image) {
    const auto bytes = write_squares({&image, 1}, {});
    const Mesh mesh = decode_surface(bytes.value(), 0).value();
    double volume = 0;
    for (const Triangle& t : mesh.triangles)
        volume += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6;
    return volume;
}

TEST(ImportImage, OutsideIsOutsideWhicheverWayTheImageIsTurned) {
    const SquareGrid folded = folded_sphere(17, 20);
    SquareGrid turned = folded;
    for (uint32_t r = 0; r < 17; ++r)
        for (uint32_t c = 0; c < 17; ++c) turned.at(c, r) = folded.at(r, c);
    EXPECT_GT(decoded_volume(import_image(planes_of(folded), 17, 1e-5).value()), 0);
    EXPECT_GT(decoded_volume(import_image(planes_of(turned), 17, 1e-5).value()), 0);
}

TEST(ImportImage, OtherSidesAreResampledToTheNextGrid) {
    SquareGrid flat;
    flat.side = 12;
    for (uint32_t r = 0; r < 12; ++r)
        for (uint32_t c = 0; c < 12; ++c) flat.positions.emplace_back(c / 11.0, r / 11.0, 0);
    const auto image = import_image(planes_of(flat), 12, 1e-6);
    ASSERT_TRUE(image.ok());
    ASSERT_EQ(image.value().side(), 17u);
    for (uint32_t r = 0; r < 17; ++r)
        for (uint32_t c = 0; c < 17; ++c)
            EXPECT_LT((image.value().at(r, c) - Vec3(c / 16.0, r / 16.0, 0)).norm(), 1e-6);
}

TEST(ImportImage, BadInputIsNamed) {
    std::vector<float> planes(3 * 81, 0.5f);
    EXPECT_FALSE(import_image(planes, 10, 1e-6).ok());
    EXPECT_FALSE(import_image(planes, 2, 1e-6).ok());
    EXPECT_FALSE(import_image(planes, 9, -1).ok());
    planes[5 * 9 + 7] = std::numeric_limits<float>::quiet_NaN();
    const auto bad = import_image(planes, 9, 1e-6);
    ASSERT_FALSE(bad.ok());
    EXPECT_NE(bad.error().message.find("row 5, column 7"), std::string::npos);
}

TEST(ImportImage, ASinglePointMatchesEverythingSoNothingIsGlued) {
    const auto image = import_image(std::vector<float>(3 * 65 * 65, 0.5f), 65, 1e-6);
    ASSERT_TRUE(image.ok());
    EXPECT_TRUE(image.value().sideband.paths.empty());
}

TEST(EncodeImage, AuthorsBunnyIsClosedWithItsFourLeavesWithinTheBytesAsked) {
    const std::vector<float> planes = read_planes("bunny-gim.gim", 257);
    if (planes.empty()) GTEST_SKIP() << "the authors' images are not here";
    const SquareImage image = import_image(planes, 257, 2e-6).value();
    EXPECT_EQ(image.sideband.paths.size(), 10u);
    EncodeOptions options;
    options.rate = {RateTarget::Kind::kBytes, 24000};
    options.fit = FitStrength::kOff;
    const auto encoded = encode_image(planes, 257, 2e-6, options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_LE(encoded.value().bytes.size(), 24000u);
    EXPECT_GE(encoded.value().bytes.size(), 23520u);
    EXPECT_TRUE(decoded_topology(image).watertight);
}

TEST(EncodeImage, SphericalBunnyOfEvenSideIsClosed) {
    const std::vector<float> planes = read_planes("bunny-sph.gim", 256);
    if (planes.empty()) GTEST_SKIP() << "the authors' images are not here";
    const auto image = import_image(planes, 256, 2e-6);
    ASSERT_TRUE(image.ok()) << image.error().message;
    EXPECT_EQ(image.value().side(), 257u);
    EXPECT_TRUE(decoded_topology(image.value()).watertight);
}

}  // namespace
}  // namespace gim

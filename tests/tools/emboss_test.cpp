// A picture on a surface: displaced where it lies and nowhere else, by its depth, without cracks; the file keeps the rest.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "corpus/generators.h"
#include "gim/decoder.h"
#include "gim/emboss.h"
#include "tests/tools/program.h"
#include "tools/decoded.h"
#include "tools/stb.h"

namespace gim {
namespace {

constexpr double kRadius = 0.35, kTube = 0.15;  // of the torus
constexpr double kDepth = 0.02, kSize = 0.16;

// A torus as a file, of each layout that can be embossed. Made once.
const Bytes& torus_file(Layout layout) {
    static std::map<Layout, Bytes> made;
    Bytes& file = made[layout];
    if (!file.empty()) return file;
    EncodeOptions options;
    options.layout = layout;
    options.side = 65;
    options.tiles = 16;
    options.samples = 16 * 17 * 17;
    options.fit = FitStrength::kOff;
    options.rate = {RateTarget::Kind::kQuality, 80};
    options.threads = 1;
    const Result<Encoded> encoded = encode(corpus::torus(96, 48, kRadius, kTube), options);
    EXPECT_TRUE(encoded.ok()) << encoded.error().message;
    if (encoded.ok()) file = encoded.value().bytes;
    return file;
}

// White, with a black left half if `half`.
HeightPicture block(uint32_t width, uint32_t height, bool half = false) {
    HeightPicture picture{width, height, std::vector<float>(size_t{width} * height, 1.0f)};
    for (size_t i = 0; half && i < picture.heights.size(); ++i) {
        if (i % width < width / 2) picture.heights[i] = 0;
    }
    return picture;
}

EmbossOptions on_top() {
    EmbossOptions options;
    options.at = std::array<double, 3>{kRadius, 0, kTube};
    options.size = kSize;
    options.depth = kDepth;
    options.up = {0, 1, 0};
    return options;
}

double height_over_torus(const float* p) {
    const double ring = std::hypot(p[0], p[1]) - kRadius;
    return std::hypot(ring, p[2]) - kTube;
}

// Whether a vertex lies so near to the picture's middle, seen from above, along x and along y.
bool is_under(const float* p, double x, double y) {
    return p[2] > 0 && std::abs(p[0] - kRadius) < x && std::abs(p[1]) < y;
}

DecodedImage decoded(const Bytes& file, WithDetails details) {
    const auto images = decode_images(file, 0, WithPlanes::kNo, details);
    EXPECT_TRUE(images.ok()) << images.error().message;
    return images.value()[0];
}

// Checks that each edge has two triangles, which run along it in opposite directions. Returns V - E + F.
int64_t euler_of_closed(const DecodedImage& image) {
    std::set<std::pair<uint32_t, uint32_t>> edges;
    std::set<uint32_t> vertices(image.triangles.begin(), image.triangles.end());
    for (size_t i = 0; i < image.triangles.size(); ++i) {
        const uint32_t to = image.triangles[i % 3 == 2 ? i - 2 : i + 1];
        EXPECT_TRUE(edges.emplace(image.triangles[i], to).second);
    }
    for (const auto& [a, b] : edges) EXPECT_TRUE(edges.contains({b, a}));
    EXPECT_EQ(vertices.size(), image.positions.size() / 3);
    return int64_t(vertices.size()) - int64_t(edges.size() / 2) + int64_t(image.triangles.size() / 3);
}

const Layout kLayouts[] = {Layout::kTiles, Layout::kGim};

TEST(Emboss, DisplacesThePictureByItsDepthAndNothingElse) {
    for (const Layout layout : kLayouts) {
        SCOPED_TRACE(static_cast<int>(layout));
        const Bytes& file = torus_file(layout);
        const Result<Embossed> embossed = emboss(file, block(64, 32), on_top());
        ASSERT_TRUE(embossed.ok()) << embossed.error().message;
        EXPECT_GT(embossed.value().texel_exponent, 0u);
        const DecodedImage plain = decoded(file, WithDetails::kYes);
        const DecodedImage image = decoded(embossed.value().bytes, WithDetails::kYes);
        EXPECT_EQ(euler_of_closed(image), 0);
        EXPECT_GT(image.triangles.size(), plain.triangles.size());
        EXPECT_LT(image.triangles.size(), 4 * plain.triangles.size());
        size_t inside = 0;
        for (size_t v = 0; v < image.positions.size(); v += 3) {
            const float* p = &image.positions[v];
            if (is_under(p, 0.4 * kSize, 0.15 * kSize)) {
                EXPECT_NEAR(height_over_torus(p), kDepth, 0.2 * kDepth);
                ++inside;
            } else if (!is_under(p, 0.7 * kSize, 0.45 * kSize)) {
                EXPECT_NEAR(height_over_torus(p), 0, 0.2 * kDepth);
            }
        }
        EXPECT_GT(inside, 20u);
    }
}

TEST(Emboss, TheBoxOfTheFileGrowsWithThePicture) {
    for (const Layout layout : kLayouts) {
        const Result<Embossed> embossed = emboss(torus_file(layout), block(64, 32), on_top());
        ASSERT_TRUE(embossed.ok());
        const Bytes& file = embossed.value().bytes;
        gim_info plain, info;
        ASSERT_EQ(gim_read_info(torus_file(layout).data(), torus_file(layout).size(), nullptr, &plain), GIM_OK);
        ASSERT_EQ(gim_read_info(file.data(), file.size(), nullptr, &info), GIM_OK);
        ASSERT_EQ(plain.has_boxes + info.has_boxes, 2u);
        EXPECT_LT(plain.box.high[2], kTube + 0.5 * kDepth);
        const DecodedImage image = decoded(file, WithDetails::kYes);
        for (size_t i = 0; i < image.positions.size(); ++i) {
            ASSERT_GE(image.positions[i], info.box.low[i % 3]);
            ASSERT_LE(image.positions[i], info.box.high[i % 3]);
        }
    }
}

// A reader without displacements sees the file as it was.
TEST(Emboss, TheSurfaceBelowKeepsItsBits) {
    for (const Layout layout : kLayouts) {
        const Bytes& file = torus_file(layout);
        const Result<Embossed> embossed = emboss(file, block(20, 20), on_top());
        ASSERT_TRUE(embossed.ok());
        const DecodedImage before = decoded(file, WithDetails::kNo);
        const DecodedImage after = decoded(embossed.value().bytes, WithDetails::kNo);
        EXPECT_EQ(after.positions, before.positions);
        EXPECT_EQ(after.triangles, before.triangles);
        EXPECT_EQ(embossed.value().bytes.size() - embossed.value().plane_bytes < file.size() + 12, true);
    }
}

TEST(Emboss, ASecondPictureKeepsTheFirst) {
    const Bytes& file = torus_file(Layout::kTiles);
    const Result<Embossed> first = emboss(file, block(40, 40), on_top());
    ASSERT_TRUE(first.ok());
    EmbossOptions below = on_top();
    below.at = std::array<double, 3>{-kRadius, 0, kTube};
    below.depth = -kDepth;
    const Result<Embossed> second = emboss(first.value().bytes, block(40, 40), below);
    ASSERT_TRUE(second.ok()) << second.error().message;
    const DecodedImage image = decoded(second.value().bytes, WithDetails::kYes);
    EXPECT_EQ(euler_of_closed(image), 0);
    double highest = 0, lowest = 0;
    for (size_t v = 0; v < image.positions.size(); v += 3) {
        highest = std::max(highest, height_over_torus(&image.positions[v]));
        lowest = std::min(lowest, height_over_torus(&image.positions[v]));
    }
    EXPECT_NEAR(highest, kDepth, 0.4 * kDepth);
    EXPECT_NEAR(lowest, -kDepth, 0.4 * kDepth);
}

// The right half of the picture lies to the right where its upper side points up, seen from outside; turned by half a
// turn, to the left.
TEST(Emboss, StandsUprightAndIsNotMirrored) {
    const Bytes& file = torus_file(Layout::kGim);
    for (const double turn : {0.0, 180.0}) {
        EmbossOptions options = on_top();
        options.turn = turn;
        const Result<Embossed> embossed = emboss(file, block(40, 40, true), options);
        ASSERT_TRUE(embossed.ok());
        const DecodedImage image = decoded(embossed.value().bytes, WithDetails::kYes);
        double right = 0, left = 0;  // seen from above, with y up
        for (size_t v = 0; v < image.positions.size(); v += 3) {
            const float* p = &image.positions[v];
            if (!is_under(p, 0.45 * kSize, 0.45 * kSize)) continue;
            double& side = p[0] > kRadius ? right : left;
            side = std::max(side, height_over_torus(p));
        }
        EXPECT_GT(turn == 0 ? right : left, 0.8 * kDepth);
        EXPECT_LT(turn == 0 ? left : right, 1.3 * kDepth);
        double far_left = 0;
        for (size_t v = 0; v < image.positions.size(); v += 3) {
            const float* p = &image.positions[v];
            const double x = turn == 0 ? kRadius - p[0] : p[0] - kRadius;
            if (is_under(p, 0.5 * kSize, 0.3 * kSize) && x > 0.1 * kSize)
                far_left = std::max(far_left, height_over_torus(p));
        }
        EXPECT_LT(far_left, 0.2 * kDepth);
    }
}

TEST(Emboss, WhatCannotBeIsAnError) {
    const Bytes& file = torus_file(Layout::kGim);
    const auto fails = [&](const Bytes& bytes, const HeightPicture& picture,
                           const std::function<void(EmbossOptions&)>& change) {
        EmbossOptions options = on_top();
        change(options);
        return !emboss(bytes, picture, options).ok();
    };
    const auto as_it_is = [](EmbossOptions&) {};
    EXPECT_TRUE(fails({1, 2, 3}, block(4, 4), as_it_is));
    EXPECT_TRUE(fails({file.begin(), file.end() - 1}, block(4, 4), as_it_is));
    EXPECT_TRUE(fails(file, {}, as_it_is));
    EXPECT_TRUE(fails(file, {2, 2, {0, 0, 0, 2}}, as_it_is));
    EXPECT_TRUE(fails(file, {2, 2, {0, 0, 0, 0}}, as_it_is));
    EXPECT_TRUE(fails(file, block(4, 4), [](EmbossOptions& o) { o.size = 0; }));
    EXPECT_TRUE(fails(file, block(4, 4), [](EmbossOptions& o) { o.size = 1e-9; }));
    EXPECT_TRUE(fails(file, block(4, 4), [](EmbossOptions& o) { o.depth = 0; }));
    EXPECT_TRUE(fails(file, block(4, 4), [](EmbossOptions& o) { o.depth = NAN; }));
    EXPECT_TRUE(fails(file, block(4, 4), [](EmbossOptions& o) { o.image = 1; }));
    EXPECT_TRUE(fails(file, block(4, 4), [](EmbossOptions& o) { o.at = EmbossOptions::TextureCoordinates{3, 3}; }));
    EXPECT_TRUE(fails(file, block(4, 4), [](EmbossOptions& o) { o.texel_exponent = 7; }));
    EXPECT_FALSE(fails(file, block(4, 4), as_it_is));
    EXPECT_FALSE(fails(file, block(4, 4), [](EmbossOptions& o) {
        o.at = EmbossOptions::TextureCoordinates{0.4, 0.6};
    }));
}

TEST(Emboss, TheProgramEmbosses) {
    const test::TemporaryFolder folder;
    const Bytes& file = torus_file(Layout::kTiles);
    test::save(folder.file("torus.gim"), {reinterpret_cast<const char*>(file.data()), file.size()});
    const std::vector<uint8_t> rgb(3 * 8 * 8, 255), png = png_bytes(rgb.data(), 8, 8);
    test::save(folder.file("white.png"), {reinterpret_cast<const char*>(png.data()), png.size()});
    const std::vector<std::string> arguments = {"emboss",
                                                folder.file("torus.gim"),
                                                folder.file("out.gim"),
                                                "--image",
                                                folder.file("white.png"),
                                                "--at",
                                                "0.35,0,0.2",
                                                "--size",
                                                "0.1",
                                                "--depth",
                                                "0.01"};
    const test::Outcome done = test::gim(arguments);
    EXPECT_EQ(done.status, 0) << done.err;
    EXPECT_NE(done.out.find("displacements"), std::string::npos);
    EXPECT_EQ(test::gim({"decode", folder.file("out.gim"), folder.file("out.ply")}).status, 0);
    auto onto_itself = arguments;
    onto_itself[2] = onto_itself[1];
    EXPECT_EQ(test::gim(onto_itself).status, 1);
    auto not_a_picture = arguments;
    not_a_picture[4] = folder.file("torus.gim");
    not_a_picture[2] = folder.file("none.gim");
    EXPECT_EQ(test::gim(not_a_picture).status, 1);
    auto nowhere = arguments;
    nowhere[6] = "1";
    EXPECT_EQ(test::gim(nowhere).status, 2);
}

}  // namespace
}  // namespace gim

#include "tools/render.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/tools/test_files.h"

namespace gim {
namespace {

using test::torus_image;

uint8_t red(const Picture& p, uint32_t x, uint32_t y) { return p.rgb[3 * (size_t{y} * p.width + x)]; }

// A square in the x-y plane, seen from +z or from behind.
Picture square(double azimuth) {
    const TriangleMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    return render_mesh(mesh, {.up = UpAxis::kY, .azimuth = azimuth, .elevation = 0, .size = 64});
}

TEST(Render, TheModelFillsThePictureAndTheBackgroundStaysFree) {
    const Picture picture = square(0);
    ASSERT_EQ(picture.rgb.size(), 3U * 64 * 64);
    EXPECT_GT(red(picture, 1, 1), 230);  // background
    const uint8_t inside = red(picture, 32, 32);
    EXPECT_LT(inside, 230);
    for (uint32_t i = 4; i < 60; ++i) EXPECT_EQ(red(picture, i, 32), inside) << "no crack along the diagonal, " << i;
}

TEST(Render, BackFacesLookDifferent) {
    const Picture front = square(0);
    const Picture back = square(180);
    const size_t i = 3 * (32 * 64 + 32);
    EXPECT_NEAR(front.rgb[i] - front.rgb[i + 2], 0, 30);  // nearly grey
    EXPECT_GT(back.rgb[i] - back.rgb[i + 2], 60);         // reddish
}

TEST(Render, NearFacesHideFarOnes) {
    // A small front square before a large one that is seen from behind.
    const TriangleMesh mesh = {{{0, 0, 0}, {0, 4, 0}, {4, 4, 0}, {4, 0, 0}, {1, 1, 1}, {3, 1, 1}, {3, 3, 1}, {1, 3, 1}},
                               {{4, 5, 6}, {4, 6, 7}, {0, 1, 2}, {0, 2, 3}}};
    const Picture picture = render_mesh(mesh, {.up = UpAxis::kY, .azimuth = 0, .elevation = 0, .size = 64});
    const size_t centre = 3 * (32 * 64 + 32);
    const size_t rim = 3 * (32 * 64 + 6);
    EXPECT_LT(picture.rgb[centre] - picture.rgb[centre + 2], 30);
    EXPECT_GT(picture.rgb[rim] - picture.rgb[rim + 2], 60);
}

TEST(Render, BrokenMeshesGiveAPicture) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(render_mesh({}, {.size = 16}).rgb.size(), 3U * 16 * 16);
    EXPECT_EQ(render_mesh({{{0, 0, 0}}, {{0, 0, 0}}}, {.size = 16}).rgb.size(), 3U * 16 * 16);
    const TriangleMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {nan, 0, 0}}, {{0, 1, 2}, {0, 1, 3}}};
    const Picture picture =
        render_mesh(mesh, {.up = UpAxis::kY, .azimuth = 0, .elevation = 0, .size = 64, .wire = true});
    EXPECT_LT(red(picture, 16, 45), 230);
}

struct Rgb {
    int r = 0, g = 0, b = 0;
};
Rgb pixel(const Picture& p, uint32_t x, uint32_t y) {
    const size_t i = 3 * (size_t{y} * p.width + x);
    return {p.rgb[i], p.rgb[i + 1], p.rgb[i + 2]};
}
bool is_red(const Rgb& c) { return c.r > 120 && c.g < 60 && c.b < 60; }
bool is_dark_red(const Rgb& c) { return c.r > 60 && c.r < 120 && c.g < 60 && c.b < 60; }
size_t count_pixels(const Picture& p, bool (*is_one)(const Rgb&)) {
    size_t count = 0;
    for (uint32_t y = 0; y < p.height; ++y) {
        for (uint32_t x = 0; x < p.width; ++x) count += is_one(pixel(p, x, y));
    }
    return count;
}

// Four squares in a row, in the x-y plane, seen from +z. The map says what is wrong with which.
TEST(Render, DefectsHaveTheirColours) {
    TriangleMesh mesh;
    for (uint32_t i = 0; i < 4; ++i) {
        for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
            mesh.positions.push_back({static_cast<double>(i) + x, static_cast<double>(y), 0});
        mesh.triangles.push_back({4 * i, 4 * i + 1, 4 * i + 2});
        mesh.triangles.push_back({4 * i, 4 * i + 2, 4 * i + 3});
    }
    DefectMap map{.folded = std::vector<uint8_t>(8, 0), .off = std::vector<float>(16, 0), .folded_back = {{13, 14}}};
    std::fill_n(map.off.begin() + 4, 4, 30.0F);
    std::fill_n(map.off.begin() + 8, 4, 60.0F);
    map.folded[6] = map.folded[7] = 1;
    const View view = {.up = UpAxis::kY, .azimuth = 0, .elevation = 0, .size = 128};
    const Picture picture = render_defects(mesh, map, view);
    const Rgb plain = pixel(picture, 20, 64), yellow = pixel(picture, 49, 64), orange = pixel(picture, 79, 64);
    EXPECT_NEAR(plain.r, plain.b, 12);
    EXPECT_NEAR(yellow.r, yellow.g, 25);
    EXPECT_GT(yellow.g, yellow.b + 40);
    EXPECT_GT(orange.r, orange.g + 50);
    EXPECT_GT(orange.g, orange.b + 40);
    EXPECT_TRUE(is_red(pixel(picture, 108, 64)));
    EXPECT_GT(count_pixels(picture, is_dark_red), 20U);  // the edge at the right end
}

TEST(Render, AFoldSmallerThanAPixelIsADot) {
    TriangleMesh mesh = {
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}, {0.5001, 0.5, 0}, {0.5, 0.5001, 0}},
        {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}}};
    const View view = {.up = UpAxis::kY, .azimuth = 0, .elevation = 0, .size = 64};
    DefectMap map{.folded = {0, 0, 1}, .off = std::vector<float>(7, 0), .folded_back = {}};
    EXPECT_GE(count_pixels(render_defects(mesh, map, view), is_red), 2U);
    map.folded[2] = 0;
    EXPECT_EQ(count_pixels(render_defects(mesh, map, view), is_red), 0U);
    // A fold closely below the surface shows, one far behind it does not.
    map.folded[2] = 1;
    for (size_t v = 4; v < 7; ++v) mesh.positions[v][2] = -0.005;
    EXPECT_GE(count_pixels(render_defects(mesh, map, view), is_red), 2U);
    for (size_t v = 4; v < 7; ++v) mesh.positions[v][2] = -0.5;
    EXPECT_EQ(count_pixels(render_defects(mesh, map, view), is_red), 0U);
}

TEST(Render, GeometryImagesShowCoordinatesAsColours) {
    const std::vector<DecodedImage> images = {torus_image(9)};
    const Picture picture = render_images(images, 90);
    EXPECT_EQ(red(picture, 5, 5), 255);  // the first sample has the largest x
    EXPECT_EQ(red(picture, 5, 45), 0);   // half way round the smallest
    EXPECT_EQ(render_images({}, 16).width, 16U);
}

TEST(Render, PanelsStandSideBySideAboveTheirCaptions) {
    const std::vector<Panel> panels = {{square(0), "one"}, {square(180), "two, with a much longer caption than fits"}};
    const Picture picture = place_side_by_side(panels);
    EXPECT_EQ(picture.width, 128U);
    EXPECT_GT(picture.height, 64U);
    EXPECT_EQ(red(picture, 32, 32), red(panels[0].picture, 32, 32));
    EXPECT_EQ(red(picture, 64 + 32, 32), red(panels[1].picture, 32, 32));
    bool has_ink = false;
    for (uint32_t y = 64; y < picture.height; ++y) {
        for (uint32_t x = 0; x < 64; ++x) has_ink = has_ink || red(picture, x, y) < 100;
    }
    EXPECT_TRUE(has_ink);

    const Result<Bytes> png = write_png(picture);
    ASSERT_TRUE(png.ok());
    EXPECT_EQ(std::string(png.value().begin() + 1, png.value().begin() + 4), "PNG");
}

}  // namespace
}  // namespace gim

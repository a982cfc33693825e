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

// The reference itself: every pixel of a square belongs to one triangle, and the nearer one shows.
#include "tests/gpu/software_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/gpu/compare_frames.h"
#include "tools/gpu/camera.h"

namespace gim {
namespace {

using namespace gim::test;

SurfaceData flat_map() {
    SurfaceData surface;
    surface.map_width = surface.map_height = 1;
    surface.normals = {0, 0, 127, 0};
    return surface;
}

// A square around (0, 0, z), as a fan of eight triangles around a place inside.
std::vector<SoftTriangle> square(float half, float z) {
    const float rim[9][2] = {{-1, -1},   {0.3f, -1}, {1, -1},    {1, 0.1f}, {1, 1},
                             {-0.2f, 1}, {-1, 1},    {-1, 0.4f}, {-1, -1}};
    std::vector<SoftTriangle> out;
    for (size_t i = 0; i < 8; ++i) {
        SoftTriangle t{};
        t.positions = {{{half * rim[i][0], half * rim[i][1], z},
                        {half * rim[i + 1][0], half * rim[i + 1][1], z},
                        {0.123f * half, 0.077f * half, z}}};
        out.push_back(t);
    }
    return out;
}

uint32_t count_of(const FramePixels& frame, uint8_t red) {
    uint32_t count = 0;
    for (size_t i = 0; i < frame.rgba.size(); i += 4) count += frame.rgba[i] == red ? 1 : 0;
    return count;
}

TEST(SoftwareFrame, ASquareHasNoGapAndNoPixelTwice) {
    Camera camera;
    camera.eye = {0, 0, 2};
    camera.field_of_view = 2 * std::atan(0.5);  // the height is 2 at distance 2
    camera.width = camera.height = 64;
    const ShaderView view = view_of(camera);
    const SurfaceData surface = flat_map();
    SoftwareFrame frame(64, 64, 1, kBackground);
    frame.draw(square(0.5f, 0), surface, {}, view);
    EXPECT_EQ(count_of(frame.pixels(), 204), 32u * 32u);  // 0.8, lit from the front
    EXPECT_EQ(covered_part(frame.pixels()), 0.25);

    frame.draw(square(0.25f, -0.1f), surface, {}, view);  // hidden
    EXPECT_EQ(covered_part(frame.pixels()), 0.25);
    ShaderInstance turned;
    turned.transform[0] = -1;  // seen from behind now
    turned.transform[10] = -1;
    frame.draw(square(0.25f, -1), surface, turned, view);  // at z = 1: twice as large
    EXPECT_EQ(count_of(frame.pixels(), 0), 32u * 32u);
}

TEST(SoftwareFrame, ComparisonsFindWhatDiffers) {
    const FramePixels empty = SoftwareFrame(8, 8, 1, kBackground).pixels();
    const SoftwareFrame fine(8, 8, kFiner, kBackground);
    FramePixels frame = empty;
    Reference reference{fine.pixels(), fine.contested()};
    const auto found = [&] { return compare_frames(frame, reference, 0); };
    const auto set = [](FramePixels& pixels, size_t row, size_t column, std::array<uint8_t, 4> colour) {
        std::copy(colour.begin(), colour.end(),
                  pixels.rgba.begin() + static_cast<ptrdiff_t>(4 * (pixels.width * row + column)));
    };
    EXPECT_EQ(found().worst, 0u);
    set(frame, 3, 3, {155, 0, 255, 255});
    EXPECT_EQ(found().worst, 100u);
    EXPECT_EQ(found().far, 1u);
    EXPECT_EQ(found().shifted, 1u);
    set(reference.samples, 13, 13, {155, 0, 255, 255});  // the centre of pixel (4, 4)
    EXPECT_EQ(found().worst, 0u);
    EXPECT_EQ(found().shifted, 2u);
    set(reference.samples, 13, 13, kBackground);
    set(reference.samples, 14, 10, {155, 0, 255, 255});  // more than a pixel away
    EXPECT_EQ(found().worst, 100u);

    frame = empty;
    set(frame, 6, 6, kBackFace);
    EXPECT_EQ(found().backs, 1u);
    reference.contested[8 * kFiner * 19 + 20] = 1;
    EXPECT_EQ(found().backs, 0u);
    for (size_t i = 0; i < reference.contested.size(); ++i) set(reference.samples, 0, i, {9, 9, 9, 255});
    frame = empty;
    EXPECT_EQ(found().background, 36u);
}

}  // namespace
}  // namespace gim

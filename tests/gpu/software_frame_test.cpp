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
    const float rim[9][2] = {{-1, -1}, {0.3f, -1}, {1, -1}, {1, 0.1f}, {1, 1}, {-0.2f, 1}, {-1, 1}, {-1, 0.4f}, {-1, -1}};
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
    SoftwareFrame frame(64, 64, kBackground);
    frame.draw(square(0.5f, 0), surface, {}, view);
    EXPECT_EQ(count_of(frame.pixels(), 204), 32u * 32u);  // 0.8, lit from the front
    EXPECT_EQ(count_covered(frame.pixels()), 32u * 32u);

    frame.draw(square(0.25f, -0.1f), surface, {}, view);  // hidden
    EXPECT_EQ(count_covered(frame.pixels()), 32u * 32u);
    ShaderInstance turned;
    turned.transform[0] = -1;  // seen from behind now
    turned.transform[10] = -1;
    frame.draw(square(0.25f, -1), surface, turned, view);  // at z = 1: twice as large
    EXPECT_EQ(count_of(frame.pixels(), 0), 32u * 32u);
}

TEST(SoftwareFrame, ComparisonsFindWhatDiffers) {
    const SoftwareFrame empty(8, 8, kBackground);
    FramePixels one = empty.pixels(), other = empty.pixels();
    EXPECT_EQ(compare_frames(one, other, 0).worst, 0u);
    one.rgba[4 * (8 * 3 + 3)] = 155;
    EXPECT_EQ(compare_frames(one, other, 0).worst, 100u);
    EXPECT_EQ(compare_frames(one, other, 0).differing, 1u);
    other.rgba[4 * (8 * 4 + 4)] = 155;  // one pixel away
    EXPECT_EQ(compare_frames(one, other, 0).worst, 0u);
    other.rgba[4 * (8 * 6 + 6)] = 0;
    other.rgba[4 * (8 * 6 + 6) + 2] = 255;
    EXPECT_EQ(find_leaks(other, one).backs, 1u);
}

}  // namespace
}  // namespace gim

#include "tests/gpu/compare_frames.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace gim::test {
namespace {

uint32_t difference(const uint8_t* a, const uint8_t* b) {
    int most = 0;
    for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(int{a[k]} - int{b[k]}));
    return static_cast<uint32_t>(most);
}

const uint8_t* pixel(const FramePixels& frame, int64_t x, int64_t y) {
    return &frame.rgba[4 * static_cast<size_t>(y * frame.width + x)];
}

// Calls visit(pixel) for the pixels that are at most one away.
template <class Visit>
void around(const FramePixels& frame, int64_t x, int64_t y, const Visit& visit) {
    for (int64_t v = std::max<int64_t>(y - 1, 0); v <= std::min<int64_t>(y + 1, frame.height - 1); ++v) {
        for (int64_t u = std::max<int64_t>(x - 1, 0); u <= std::min<int64_t>(x + 1, frame.width - 1); ++u)
            visit(pixel(frame, u, v));
    }
}

bool is(const uint8_t* shown, const std::array<uint8_t, 4>& colour) {
    return difference(shown, colour.data()) == 0;
}

void compare_one_way(const FramePixels& one, const FramePixels& other, uint32_t close, FrameDifference* out) {
    for (int64_t y = 0; y < one.height; ++y) {
        for (int64_t x = 0; x < one.width; ++x) {
            const uint8_t* shown = pixel(one, x, y);
            uint32_t least = 255;
            around(other, x, y, [&](const uint8_t* near) { least = std::min(least, difference(shown, near)); });
            out->worst = std::max(out->worst, least);
            out->differing += difference(shown, pixel(other, x, y)) > close ? 1 : 0;
        }
    }
}

}  // namespace

FrameDifference compare_frames(const FramePixels& one, const FramePixels& other, uint32_t close) {
    FrameDifference found;
    compare_one_way(one, other, close, &found);
    compare_one_way(other, one, close, &found);
    found.differing /= 2;
    return found;
}

Leaks find_leaks(const FramePixels& frame, const FramePixels& reference) {
    Leaks leaks;
    for (int64_t y = 0; y < frame.height; ++y) {
        for (int64_t x = 0; x < frame.width; ++x) {
            const uint8_t* shown = pixel(frame, x, y);
            const auto is_leak = [&](const std::array<uint8_t, 4>& colour) {
                bool has_none = is(shown, colour);
                around(reference, x, y, [&](const uint8_t* near) { has_none = has_none && !is(near, colour); });
                return has_none;
            };
            leaks.background += is_leak(kBackground) ? 1 : 0;
            leaks.backs += is_leak(kBackFace) ? 1 : 0;
        }
    }
    return leaks;
}

uint32_t count_covered(const FramePixels& frame) {
    uint32_t covered = 0;
    for (size_t i = 0; i < frame.rgba.size(); i += 4) covered += is(&frame.rgba[i], kBackground) ? 0 : 1;
    return covered;
}

void keep_frame(const FramePixels& frame, const std::string& name) {
    const char* folder = std::getenv("GIM_GPU_FRAMES");
    if (!folder) return;
    std::ofstream file(std::string(folder) + "/" + name + ".ppm", std::ios::binary);
    file << "P6 " << frame.width << " " << frame.height << " 255\n";
    for (size_t i = 0; i < frame.rgba.size(); i += 4)
        file.write(reinterpret_cast<const char*>(&frame.rgba[i]), 3);
}

}  // namespace gim::test

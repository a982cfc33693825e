// How two frames of one surface differ.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "tools/gpu/frame_pixels.h"

namespace gim::test {

inline constexpr std::array<uint8_t, 4> kBackground = {255, 0, 255, 255};
inline constexpr std::array<uint8_t, 4> kBackFace = {0, 0, 255, 255};  // ShaderView.back

struct FrameDifference {
    uint32_t worst = 0;      // over all pixels: the least difference to a pixel of the other frame at most one pixel away
    uint32_t differing = 0;  // pixels that differ from the pixel at the same place by more than `worst` may be
};
// In both directions. close: what `differing` lets pass.
FrameDifference compare_frames(const FramePixels& one, const FramePixels& other, uint32_t close);

// Pixels of a frame that show what a closed surface hides, and that no pixel of the reference within one pixel shows.
struct Leaks {
    uint32_t background = 0, backs = 0;
};
Leaks find_leaks(const FramePixels& frame, const FramePixels& reference);

// Pixels that show the surface.
uint32_t count_covered(const FramePixels& frame);

// Writes NAME.ppm into the folder GIM_GPU_FRAMES, if that variable is set, for people to look at.
void keep_frame(const FramePixels& frame, const std::string& name);

}  // namespace gim::test

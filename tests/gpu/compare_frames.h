// How a frame differs from the reference.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/gpu/frame_pixels.h"

namespace gim::test {

inline constexpr std::array<uint8_t, 4> kBackground = {255, 0, 255, 255};
inline constexpr std::array<uint8_t, 4> kBackFace = {0, 0, 255, 255};  // ShaderView.back

// The reference has 3 x 3 samples for each pixel of a frame, so that it knows what is smaller than a pixel.
inline constexpr uint32_t kFiner = 3;

struct Reference {
    FramePixels samples;
    std::vector<uint8_t> contested;  // per sample, SoftwareFrame::contested; there any part of the surface will do
};

// Of all pixels but those at the rim of the frame: what is within one pixel of them lies outside in part.
struct FrameDifference {
    // Over all pixels: the least difference to a sample of the reference that is at most one pixel away, and the other way
    // round from the sample in the pixel's centre.
    uint32_t worst = 0;
    uint32_t far = 0;      // pixels for which it is more than `close`
    uint32_t shifted = 0;  // pixels that differ from the sample in their centre by more than `close`
    // Pixels of the frame that show what a closed surface hides, where no sample of the reference within one pixel does.
    uint32_t background = 0, backs = 0;
};
FrameDifference compare_frames(const FramePixels& frame, const Reference& reference, uint32_t close);

// Parts of the picture, 0..1: what shows the surface, what is contested.
double covered_part(const FramePixels& frame);
double contested_part(const Reference& reference);

// Writes NAME.ppm into the folder GIM_GPU_FRAMES, if that variable is set, for people to look at.
void keep_frame(const FramePixels& frame, const std::string& name);

}  // namespace gim::test

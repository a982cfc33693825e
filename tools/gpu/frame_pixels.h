// A picture that was drawn.
#pragma once

#include <cstdint>
#include <vector>

namespace gim {

struct FramePixels {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgba;  // top row first
};

}  // namespace gim

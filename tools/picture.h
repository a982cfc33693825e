// Pictures as bytes: captions below panels, panels side by side, PNG.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gim/encoder.h"
#include "tools/file.h"

namespace gim {

struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;  // row-major, top row first
};

struct Panel {
    Picture picture;
    std::string caption;
};
// Places panels of equal height from left to right, captions below.
Picture place_side_by_side(std::span<const Panel> panels);
// Places pictures of equal width from top to bottom.
Picture place_below(const Picture& top, const Picture& bottom);

Result<Bytes> write_png(const Picture& picture);

}  // namespace gim

// The two things that we take from the stb headers, which are not warning-clean and stay behind this wall.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gim {

// PNG file of 8-bit rgb rows, top first; empty on failure.
std::vector<uint8_t> png_bytes(const uint8_t* rgb, uint32_t width, uint32_t height);

// A text in a small fixed font as filled boxes, origin at the top left, capitals 7 units high.
struct TextBox {
    double left, top, right, bottom;
};
std::vector<TextBox> text_boxes(const std::string& text);

}  // namespace gim

// The functions of the stb headers that gim uses. Those headers give warnings, so only stb.cpp includes them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gim {

// PNG file of 8-bit rgb rows, top first; empty on failure.
std::vector<uint8_t> png_bytes(const uint8_t* rgb, uint32_t width, uint32_t height);

// PNG file of 16-bit rgb rows, top first; empty on failure.
std::vector<uint8_t> png16_bytes(const uint16_t* rgb, uint32_t width, uint32_t height);

// An image file (PNG, JPEG, TGA, BMP, ...) as 8-bit rgb, top row first. Empty if it is no image or above 2^28 pixels.
struct DecodedPicture {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;
};
// What the header of an image file claims, 0 if it is none.
uint64_t pixels_in_picture(std::span<const uint8_t> file);
DecodedPicture decode_picture(std::span<const uint8_t> file);

// A text in a small fixed font, as filled boxes. Origin at the top left, capitals 7 units high.
struct TextBox {
    double left, top, right, bottom;
};
std::vector<TextBox> text_boxes(const std::string& text);

}  // namespace gim

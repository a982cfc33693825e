// A picture that a texture shows, with its filter.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace gim {

// How coordinates outside 0..1 are meant; the numbers of glTF.
enum class TextureWrap : uint32_t { kClamp = 33071, kMirror = 33648, kRepeat = 10497 };

struct RgbaPicture {
    uint32_t width = 0, height = 0;
    bool is_jpeg = false, has_alpha = false;
    std::vector<uint8_t> pixels;  // 4 * width * height, top row first
};

// Decodes PNG, JPEG and what else stb_image reads. Empty if it cannot.
RgbaPicture decode_rgba(std::span<const uint8_t> file);

// Interpolates bilinearly at (u, v), with (0, 0) the top left corner. srgb: red, green and blue become linear light first.
// Returns 0..1.
std::array<double, 4> sample(const RgbaPicture& picture, double u, double v, TextureWrap wrap_u, TextureWrap wrap_v,
                             bool srgb);

// Linear light to 0..255.
uint8_t srgb_byte(double linear);
double srgb_to_linear(double value);

// channels: 3 or 4.
std::vector<uint8_t> encode_png(const std::vector<uint8_t>& pixels, uint32_t width, uint32_t height, int channels);
// channels: 3.
std::vector<uint8_t> encode_jpeg(const std::vector<uint8_t>& pixels, uint32_t width, uint32_t height);

}  // namespace gim

#include "tools/plane_write.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/stb.h"
#include "tools/surface_write.h"

namespace gim {
namespace {

Result<Bytes> png_or_error(Bytes bytes) {
    if (bytes.empty()) return Error{Stage::kWrite, "the picture is too large for PNG; use .exr"};
    return bytes;
}

float to_linear(float s) { return s <= 0.04045F ? s / 12.92F : std::pow((s + 0.055F) / 1.055F, 2.4F); }

}  // namespace

std::vector<uint8_t> color_pixels(const ImagePlane& colors) {
    std::vector<uint8_t> rgb;
    rgb.reserve(colors.values.size());
    for (const float v : colors.values) rgb.push_back(static_cast<uint8_t>(std::lround(255 * v)));
    return rgb;
}

Result<Bytes> write_color_png(const ImagePlane& colors) {
    return png_or_error(png_bytes(color_pixels(colors).data(), colors.columns, colors.rows));
}

Result<Bytes> write_normal_png(const ImagePlane& normals) {
    std::vector<uint16_t> rgb;
    rgb.reserve(normals.values.size());
    for (const float v : normals.values) {
        rgb.push_back(
            static_cast<uint16_t>(std::lround(32767.5 * (1 + std::clamp(static_cast<double>(v), -1.0, 1.0)))));
    }
    return png_or_error(png16_bytes(rgb.data(), normals.columns, normals.rows));
}

Result<Bytes> write_normal_exr(const ImagePlane& normals) {
    return write_triples_exr(normals.columns, normals.rows, normals.values, {"X", "Y", "Z"});
}

Result<Bytes> write_color_exr(const ImagePlane& colors) {
    std::vector<float> linear = colors.values;
    for (float& v : linear) v = to_linear(v);
    return write_triples_exr(colors.columns, colors.rows, linear, {"R", "G", "B"});
}

std::array<uint8_t, 3> color_at(const ImagePlane& colors, double u, double v) {
    const double x = std::clamp(u, 0.0, 1.0) * (colors.columns - 1), y = std::clamp(v, 0.0, 1.0) * (colors.rows - 1);
    const uint32_t r = std::min(static_cast<uint32_t>(y), colors.rows - 2);
    const uint32_t c = std::min(static_cast<uint32_t>(x), colors.columns - 2);
    const double t = y - r, s = x - c;
    std::array<uint8_t, 3> rgb = {};
    for (size_t k = 0; k < 3; ++k) {
        const auto at = [&](uint32_t i, uint32_t j) {
            return static_cast<double>(colors.values[(size_t{i} * colors.columns + j) * 3 + k]);
        };
        const double value =
            (1 - t) * ((1 - s) * at(r, c) + s * at(r, c + 1)) + t * ((1 - s) * at(r + 1, c) + s * at(r + 1, c + 1));
        rgb[k] = static_cast<uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
    }
    return rgb;
}

}  // namespace gim

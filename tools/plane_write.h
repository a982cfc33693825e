// Writes attribute planes as picture files.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/decoded.h"

namespace gim {

// sRGB colours as 8-bit rgb, one pixel per sample, top row first.
std::vector<uint8_t> color_pixels(const ImagePlane& colors);
Result<Bytes> write_color_png(const ImagePlane& colors);

// Object-space normals, n -> round(32767.5 * (1 + n)) in 16 bits.
Result<Bytes> write_normal_png(const ImagePlane& normals);

// OpenEXR, float32. Normals are in object space, channels X Y Z. Colours are linear, channels R G B.
Result<Bytes> write_normal_exr(const ImagePlane& normals);
Result<Bytes> write_color_exr(const ImagePlane& colors);

// Returns the colour at u, v of the image: 0..1 along columns and rows.
std::array<uint8_t, 3> color_at(const ImagePlane& colors, double u, double v);

}  // namespace gim

#include "tools/texture_picture.h"

#include <algorithm>
#include <cmath>

#include "tools/stb.h"

namespace gim {
namespace {

// The pixel that a row or column outside the picture shows.
uint32_t wrapped(double i, uint32_t n, TextureWrap wrap) {
    if (wrap == TextureWrap::kClamp) return static_cast<uint32_t>(std::clamp(i, 0.0, n - 1.0));
    const double period = wrap == TextureWrap::kMirror ? 2.0 * n : 1.0 * n;
    double m = std::fmod(i, period);
    if (m < 0) m += period;
    if (m >= n) m = period - 1 - m;
    return std::min(static_cast<uint32_t>(std::max(m, 0.0)), n - 1);
}

const std::array<double, 256>& linear_of_byte() {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> all{};
        for (size_t i = 0; i < all.size(); ++i) all[i] = srgb_to_linear(static_cast<double>(i) / 255);
        return all;
    }();
    return table;
}

}  // namespace

double srgb_to_linear(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

uint8_t srgb_byte(double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    return static_cast<uint8_t>(std::lround(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055)));
}

std::array<double, 4> sample(const RgbaPicture& picture, double u, double v, TextureWrap wrap_u, TextureWrap wrap_v,
                             bool srgb) {
    std::array<double, 4> sum{};
    if (!std::isfinite(u) || !std::isfinite(v)) return sum;
    const double x = u * picture.width - 0.5, y = v * picture.height - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    for (int r = 0; r < 2; ++r) {
        for (int c = 0; c < 2; ++c) {
            const double weight = (r ? y - top : 1 - (y - top)) * (c ? x - left : 1 - (x - left));
            if (weight == 0) continue;
            const size_t at = size_t{wrapped(top + r, picture.height, wrap_v)} * picture.width +
                              wrapped(left + c, picture.width, wrap_u);
            const uint8_t* pixel = &picture.pixels[4 * at];
            for (size_t k = 0; k < 3; ++k) sum[k] += weight * (srgb ? linear_of_byte()[pixel[k]] : pixel[k] / 255.0);
            sum[3] += weight * pixel[3] / 255.0;
        }
    }
    return sum;
}

}  // namespace gim

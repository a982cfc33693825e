#include "encoder/planes/input_colors.h"

#include <algorithm>
#include <cmath>

#include "encoder/base/parallel.h"
#include "encoder/planes/input_triangles.h"

namespace gim {

namespace {

using Color = std::array<float, 3>;

// Interpolates bilinearly. Rows and columns repeat.
Color texel(const TextureImage& image, double u, double v) {
    const double x = u * image.width - 0.5, y = v * image.height - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const auto wrap = [](double i, uint32_t n) {
        const double m = std::fmod(i, n);
        return std::min(static_cast<uint32_t>(m < 0 ? m + n : m), n - 1);
    };
    const uint32_t columns[2] = {wrap(left, image.width), wrap(left + 1, image.width)};
    const uint32_t rows[2] = {wrap(top, image.height), wrap(top + 1, image.height)};
    const double right_part = x - left, lower_part = y - top;
    Color color{};
    for (int r = 0; r < 2; ++r) {
        for (int c = 0; c < 2; ++c) {
            const double weight = (r ? lower_part : 1 - lower_part) * (c ? right_part : 1 - right_part);
            const uint8_t* rgb = image.rgb.data() + (size_t{rows[r]} * image.width + columns[c]) * 3;
            for (size_t k = 0; k < 3; ++k) color[k] += static_cast<float>(weight * rgb[k]);
        }
    }
    return color;
}

// Colours are multiplied as linear light.
double to_linear(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }
double to_srgb(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }

float times(float level, float factor) {
    if (factor == 1.0f) return level;
    return static_cast<float>(255 * to_srgb(to_linear(level / 255.0) * to_linear(factor)));
}

}  // namespace

Result<void> check_appearance(const TriangleMesh& mesh) {
    const auto bad = [](const char* what) { return Error{Stage::kInput, what}; };
    const Appearance& a = mesh.appearance;
    const size_t faces = mesh.triangles.size();
    const auto fits = [&](size_t size) { return size == 0 || size == faces; };
    if (!fits(a.corner_colors.size()) || !fits(a.corner_texcoords.size()) || !fits(a.triangle_texture.size()))
        return bad("the mesh's colours must have one entry per triangle, or none at all");
    for (const TextureImage& image : a.textures) {
        if (image.width == 0 || image.height == 0 || image.rgb.size() != size_t{image.width} * image.height * 3)
            return bad("a texture's bytes do not fit its size");
    }
    for (const uint32_t t : a.triangle_texture) {
        if (t != UINT32_MAX && (t >= a.textures.size() || a.corner_texcoords.empty()))
            return bad("a triangle has a texture that is not there, or no texture coordinates");
    }
    return {};
}

InputColors::InputColors(const TriangleMesh& mesh, uint32_t threads)
    : mesh_(mesh), tree_(triangles_with_area(mesh, &source_), threads), threads_(threads) {}

std::vector<float> InputColors::at(std::span<const Vec3> points) const {
    const std::vector<ClosestPoint> found = tree_.find_all(points, threads_);
    std::vector<float> colors(points.size() * 3);
    parallel_blocks(points.size(), 4096, threads_, [&](size_t, size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Color c = color(found[i]);
            std::copy(c.begin(), c.end(), colors.begin() + static_cast<ptrdiff_t>(3 * i));
        }
    });
    return colors;
}

std::array<float, 3> InputColors::color(const ClosestPoint& at) const {
    Color color = {255, 255, 255};
    if (at.triangle == kNone) return color;
    const uint32_t f = source_[at.triangle];
    const Appearance& a = mesh_.appearance;
    const uint32_t texture = a.triangle_texture.empty() ? UINT32_MAX : a.triangle_texture[f];
    if (texture != UINT32_MAX) {
        double u = 0, v = 0;
        for (size_t i = 0; i < 3; ++i) {
            u += at.barycentric[i] * static_cast<double>(a.corner_texcoords[f][i][0]);
            v += at.barycentric[i] * static_cast<double>(a.corner_texcoords[f][i][1]);
        }
        if (std::isfinite(u) && std::isfinite(v)) color = texel(a.textures[texture], u, v);
    }
    if (!a.corner_colors.empty()) {
        for (size_t k = 0; k < 3; ++k) {
            double factor = 0;
            for (size_t i = 0; i < 3; ++i) factor += at.barycentric[i] * static_cast<double>(a.corner_colors[f][i][k]);
            const auto bounded = static_cast<float>(factor >= 0 ? std::min(factor, 1.0) : 0.0);  // 0 for a NaN
            color[k] = texture == UINT32_MAX ? 255 * bounded : times(color[k], bounded);
        }
    }
    return color;
}

}  // namespace gim

#include "tests/gpu/software_frame.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace gim::test {
namespace {

constexpr int64_t kUnit = 256;  // of a sample

std::array<double, 4> times(const std::array<float, 16>& m, const std::array<double, 4>& v) {
    std::array<double, 4> out{};
    for (size_t c = 0; c < 4; ++c) {
        for (size_t r = 0; r < 4; ++r) out[r] += m[4 * c + r] * v[c];
    }
    return out;
}

using Normal = std::array<double, 3>;

// The mean of the four texels around a place.
Normal filtered(const SurfaceData& surface, double column, double row) {
    const auto clamped = [](double place, uint32_t size) { return std::clamp(place, 0.0, size - 1.0); };
    const double x = std::floor(column), y = std::floor(row);
    Normal sum{};
    for (int k = 0; k < 4; ++k) {
        const int dx = k % 2, dy = k / 2;
        const double weight = (dx > 0 ? column - x : 1 - column + x) * (dy > 0 ? row - y : 1 - row + y);
        const size_t i = static_cast<size_t>(clamped(y + dy, surface.map_height)) * surface.map_width +
                         static_cast<size_t>(clamped(x + dx, surface.map_width));
        for (size_t a = 0; a < 3; ++a) sum[a] += weight * surface.normals[4 * i + a] / 127;
    }
    return sum;
}

std::array<uint8_t, 4> lit(const Normal& map_normal, const ShaderInstance& instance, const ShaderView& view) {
    const auto turned = times(instance.transform, {map_normal[0], map_normal[1], map_normal[2], 0});
    const double length = std::sqrt(turned[0] * turned[0] + turned[1] * turned[1] + turned[2] * turned[2]);
    double towards = 0;
    for (size_t a = 0; a < 3; ++a) towards += turned[a] * view.light[a] / std::max(length, 1e-6);
    const double shade = view.light[3] + (1 - view.light[3]) * std::max(towards, 0.0);
    std::array<uint8_t, 4> colour{0, 0, 0, 255};
    for (size_t a = 0; a < 3; ++a)
        colour[a] = static_cast<uint8_t>(std::lround(255 * std::clamp(view.front[a] * shade, 0.0, 1.0)));
    return colour;
}

}  // namespace

SoftwareFrame::SoftwareFrame(uint32_t width, uint32_t height, uint32_t finer, std::array<uint8_t, 4> background,
                             uint32_t parts)
    : finer_(finer),
      rounding_(kUnit * finer / parts),
      pixels_{finer * width, finer * height, std::vector<uint8_t>(size_t{4} * finer * width * finer * height)},
      depth_(pixels_.rgba.size() / 4, 1.0),
      error_(depth_.size()),
      hidden_(depth_.size(), 2),
      is_thin_(depth_.size()) {
    for (size_t i = 0; i < pixels_.rgba.size(); ++i) pixels_.rgba[i] = background[i % 4];
}

SoftwareFrame::Corner SoftwareFrame::project(const std::array<float, 3>& position, const ShaderInstance& instance,
                                             const ShaderView& view) const {
    const auto clip = times(view.world_to_clip, times(instance.transform, {position[0], position[1], position[2], 1}));
    assert(clip[3] > 0);
    const auto rounded = [&](double part, uint32_t samples) {
        return std::llround(part * samples * kUnit / static_cast<double>(rounding_)) * rounding_;
    };
    return {rounded(0.5 + clip[0] / clip[3] / 2, pixels_.width), rounded(0.5 - clip[1] / clip[3] / 2, pixels_.height),
            clip[2] / clip[3], clip[3]};
}

// GPUs round corners, each its own way, and depths to 24 bits.
double SoftwareFrame::depth_error(const std::array<Corner, 3>& c, double doubled_area) const {
    const double slope_x = (c[1].depth - c[0].depth) * static_cast<double>(c[2].y - c[0].y) -
                           (c[2].depth - c[0].depth) * static_cast<double>(c[1].y - c[0].y);
    const double slope_y = (c[1].depth - c[0].depth) * static_cast<double>(c[2].x - c[0].x) -
                           (c[2].depth - c[0].depth) * static_cast<double>(c[1].x - c[0].x);
    return 4 * static_cast<double>(rounding_) * (std::abs(slope_x) + std::abs(slope_y)) / std::abs(doubled_area) + 1e-6;
}

std::vector<uint8_t> SoftwareFrame::contested() const {
    std::vector<uint8_t> out(depth_.size());
    for (size_t i = 0; i < out.size(); ++i) out[i] = is_thin_[i] != 0 || hidden_[i] <= depth_[i] + error_[i] ? 1 : 0;
    return out;
}

// shade(weights, is_front) gives the colour of a place with these weights of the corners.
template <class Shade>
void SoftwareFrame::fill(const std::array<Corner, 3>& corners, const Shade& shade) {
    const auto doubled_area = [](const Corner& a, const Corner& b, int64_t x, int64_t y) {
        return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    };
    const int64_t whole = doubled_area(corners[0], corners[1], corners[2].x, corners[2].y);
    if (whole == 0) return;
    const int64_t sign = whole > 0 ? 1 : -1;
    const double error = depth_error(corners, static_cast<double>(whole));
    int64_t around = 0;
    for (size_t k = 0; k < 3; ++k)
        around += std::abs(corners[k].x - corners[(k + 1) % 3].x) + std::abs(corners[k].y - corners[(k + 1) % 3].y);
    const bool is_thin = std::abs(whole) <= around * rounding_;
    const auto [low_x, high_x] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
    const auto [low_y, high_y] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
    const auto first = [](int64_t low) { return std::max<int64_t>(low / kUnit - 1, 0); };
    const auto end = [](int64_t high, uint32_t size) { return std::min<int64_t>(high / kUnit + 1, size); };
    for (int64_t y = first(low_y); y < end(high_y, pixels_.height); ++y) {
        for (int64_t x = first(low_x); x < end(high_x, pixels_.width); ++x) {
            std::array<double, 3> weights{};
            bool is_in = true, is_near = whole > 0;  // a back that nearly covers the sample
            for (size_t k = 0; k < 3 && (is_in || is_near); ++k) {
                const Corner &a = corners[(k + 1) % 3], &b = corners[(k + 2) % 3];
                const int64_t area = sign * doubled_area(a, b, x * kUnit + kUnit / 2, y * kUnit + kUnit / 2);
                const int64_t right = sign * (b.x - a.x), down = sign * (b.y - a.y);
                const bool has_edge = down < 0 || (down == 0 && right > 0);  // left and top edges
                is_in = is_in && (area > 0 || (area == 0 && has_edge));
                is_near = is_near && area >= -rounding_ * (std::abs(right) + std::abs(down));
                weights[k] = static_cast<double>(area) / static_cast<double>(sign * whole);
            }
            if (!is_in && !is_near) continue;
            double depth = 0, nearness = 0;
            for (size_t k = 0; k < 3; ++k) {
                depth += weights[k] * corners[k].depth;
                weights[k] /= corners[k].distance;
                nearness += weights[k];
            }
            const size_t i = static_cast<size_t>(y) * pixels_.width + static_cast<size_t>(x);
            if (depth < 0 || depth >= 1) continue;
            if (!is_in || depth >= depth_[i]) {
                hidden_[i] = std::min(hidden_[i], depth - error);
                continue;
            }
            if (depth_[i] < 1) hidden_[i] = std::min(hidden_[i], depth_[i] - error_[i]);
            depth_[i] = depth;
            error_[i] = error;
            is_thin_[i] = is_thin ? 1 : 0;
            for (double& weight : weights) weight /= nearness;
            const std::array<uint8_t, 4> colour = shade(weights, whole < 0);  // y runs down here
            std::copy(colour.begin(), colour.end(), pixels_.rgba.begin() + static_cast<ptrdiff_t>(4 * i));
        }
    }
}

void SoftwareFrame::draw(std::span<const SoftTriangle> triangles, const SurfaceData& surface,
                         const ShaderInstance& instance, const ShaderView& view) {
    std::array<uint8_t, 4> back{};
    for (size_t a = 0; a < 4; ++a) back[a] = static_cast<uint8_t>(std::lround(255 * view.back[a]));
    for (const SoftTriangle& t : triangles) {
        std::array<Corner, 3> corners{};
        for (size_t k = 0; k < 3; ++k) corners[k] = project(t.positions[k], instance, view);
        fill(corners, [&](const std::array<double, 3>& weights, bool is_front) {
            if (!is_front) return back;
            double column = 0, row = 0;
            for (size_t k = 0; k < 3; ++k) {
                column += weights[k] * t.texels[k][0];
                row += weights[k] * t.texels[k][1];
            }
            return lit(filtered(surface, column, row), instance, view);
        });
    }
}

}  // namespace gim::test

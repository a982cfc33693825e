#include "tools/canvas.h"

namespace gim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kBias = 1e-3;  // lifts a mark off its surface; in nearness, 1 / radii
const Vector3d kBackgroundTop(0.97, 0.975, 0.98);
const Vector3d kBackgroundBottom(0.86, 0.875, 0.90);

uint8_t to_byte(double light) {
    return static_cast<uint8_t>(std::lround(255 * std::pow(std::clamp(light, 0.0, 1.0), 1 / 2.2)));
}

void mark(size_t sample, double nearness, const Canvas& canvas, MarkMask& mask) {
    const bool in_front = static_cast<float>(nearness + kBias) >= canvas.depth[sample];
    mask[sample] = std::max<uint8_t>(mask[sample], in_front ? 2 : 1);
}

}  // namespace

Canvas::Canvas(uint32_t pixels)
    : side(pixels * kSupersampling),
      depth(size_t{side} * side, -std::numeric_limits<float>::infinity()),
      colour(size_t{side} * side) {
    for (uint32_t row = 0; row < side; ++row) {
        const double s = static_cast<double>(row) / side;
        const Vector3d background = (1 - s) * kBackgroundTop + s * kBackgroundBottom;
        std::fill_n(colour.begin() + static_cast<std::ptrdiff_t>(size_t{row} * side), side,
                    linear(background).cast<float>());
    }
}

void mark_line(const Corner& from, const Corner& to, double pen_radius, const Canvas& canvas, MarkMask& mask) {
    const double pen = pen_radius * kSupersampling;
    const double length = (to.pixel - from.pixel).norm();
    if (!std::isfinite(length)) return;
    const auto steps = static_cast<uint32_t>(std::min(length, 4.0 * canvas.side)) + 1;
    const auto last = static_cast<double>(canvas.side) - 1;
    for (uint32_t i = 0; i <= steps; ++i) {
        const double t = static_cast<double>(i) / steps;
        const Vector2d p = (1 - t) * from.pixel + t * to.pixel;
        const double nearness = (1 - t) * from.nearness + t * to.nearness;
        for (double y = std::ceil(std::max(p.y() - pen, 0.0)); y <= std::min(p.y() + pen, last); ++y) {
            for (double x = std::ceil(std::max(p.x() - pen, 0.0)); x <= std::min(p.x() + pen, last); ++x) {
                if ((Vector2d(x, y) - p).squaredNorm() > pen * pen) continue;
                mark(static_cast<size_t>(y) * canvas.side + static_cast<size_t>(x), nearness, canvas, mask);
            }
        }
    }
}

void mark_triangle(const std::array<Corner, 3>& corners, double pen_radius, const Canvas& canvas, MarkMask& mask) {
    for_each_sample(corners, canvas.side, [&](size_t sample, const std::array<double, 3>&, double nearness) {
        mark(sample, nearness, canvas, mask);
    });
    for (size_t k = 0; k < 3; ++k) mark_line(corners[k], corners[(k + 1) % 3], pen_radius, canvas, mask);
}

void paint_marks(const MarkMask& mask, const Vector3d& colour, float visible_behind, Canvas& canvas) {
    const Eigen::Vector3f light = linear(colour).cast<float>();
    for (size_t k = 0; k < mask.size(); ++k) {
        if (mask[k] == 0) continue;
        const float part = mask[k] == 2 ? 1.0F : visible_behind;
        canvas.colour[k] = (1 - part) * canvas.colour[k] + part * light;
    }
}

Picture average(const Canvas& canvas) {
    Picture picture;
    picture.width = picture.height = canvas.side / kSupersampling;
    picture.rgb.reserve(size_t{3} * picture.width * picture.height);
    for (uint32_t row = 0; row < picture.height; ++row) {
        for (uint32_t column = 0; column < picture.width; ++column) {
            Eigen::Vector3f sum = Eigen::Vector3f::Zero();
            for (uint32_t i = 0; i < kSupersampling; ++i) {
                for (uint32_t j = 0; j < kSupersampling; ++j) {
                    sum += canvas.colour[size_t{row * kSupersampling + i} * canvas.side + column * kSupersampling + j];
                }
            }
            for (int k = 0; k < 3; ++k) {
                picture.rgb.push_back(to_byte(static_cast<double>(sum[k]) / (kSupersampling * kSupersampling)));
            }
        }
    }
    return picture;
}

}  // namespace gim

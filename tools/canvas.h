// A picture in the making: supersampled, with depth. Draws triangles and marks whose corners are in samples already.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "tools/picture.h"

namespace gim {

inline constexpr uint32_t kSupersampling = 3;
inline const Eigen::Vector3d kWire(0.10, 0.14, 0.22);

// Samples of the picture, kSupersampling times finer on each axis.
struct Canvas {
    explicit Canvas(uint32_t pixels);

    uint32_t side;
    std::vector<float> depth;  // larger is nearer
    std::vector<Eigen::Vector3f> colour;
};

struct Corner {
    Eigen::Vector2d pixel;
    double nearness = 0;
};

inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Returns the light of a colour.
inline Eigen::Vector3d linear(const Eigen::Vector3d& colour) { return colour.array().pow(2.2); }

// Calls visit(index, weights of the corners, nearness) for each sample inside the triangle.
template <class Visit>
void for_each_sample(const std::array<Corner, 3>& corners, uint32_t side, const Visit& visit) {
    const Eigen::Vector2d& a = corners[0].pixel;
    const Eigen::Vector2d& b = corners[1].pixel;
    const Eigen::Vector2d& c = corners[2].pixel;
    const double doubled_area = cross(b - a, c - a);
    if (doubled_area == 0) return;
    const double last = side - 1.0;
    const Eigen::Vector2d low = a.cwiseMin(b).cwiseMin(c).cwiseMax(0.0);
    const Eigen::Vector2d high = a.cwiseMax(b).cwiseMax(c).cwiseMin(last);
    if (low.x() > high.x() || low.y() > high.y()) return;
    for (auto y = static_cast<uint32_t>(std::floor(low.y())); y <= static_cast<uint32_t>(high.y()); ++y) {
        for (auto x = static_cast<uint32_t>(std::floor(low.x())); x <= static_cast<uint32_t>(high.x()); ++x) {
            const Eigen::Vector2d p(x, y);
            const std::array<double, 3> weight = {cross(b - p, c - p) / doubled_area,
                                                  cross(c - p, a - p) / doubled_area,
                                                  cross(a - p, b - p) / doubled_area};
            if (weight[0] < 0 || weight[1] < 0 || weight[2] < 0) continue;
            double nearness = 0;
            for (size_t k = 0; k < 3; ++k) nearness += weight[k] * corners[k].nearness;
            visit(size_t{y} * side + x, weight, nearness);
        }
    }
}

// paint(weights) returns the linear light at the point with these weights of the corners.
template <class Paint>
void draw_triangle(const std::array<Corner, 3>& corners, bool wire, const Paint& paint, Canvas& canvas) {
    const Eigen::Vector2d& a = corners[0].pixel;
    const Eigen::Vector2d& b = corners[1].pixel;
    const Eigen::Vector2d& c = corners[2].pixel;
    // A corner's weight times this is the distance from the opposite edge, in samples.
    const double doubled_area = std::abs(cross(b - a, c - a));
    const std::array<double, 3> height = {doubled_area / (c - b).norm(), doubled_area / (a - c).norm(),
                                          doubled_area / (b - a).norm()};
    const auto visit = [&](size_t i, const std::array<double, 3>& weight, double nearness) {
        if (static_cast<float>(nearness) <= canvas.depth[i]) return;
        canvas.depth[i] = static_cast<float>(nearness);
        double edge_distance = std::numeric_limits<double>::infinity();
        for (size_t k = 0; k < 3; ++k) edge_distance = std::min(edge_distance, weight[k] * height[k]);
        const bool on_edge = wire && edge_distance < 0.4 * kSupersampling;
        canvas.colour[i] = (on_edge ? linear(kWire) : Eigen::Vector3d(paint(weight))).cast<float>();
    };
    for_each_sample(corners, canvas.side, visit);
}

// Per sample. 0: no mark, 1: a mark behind the surface, 2: a mark in front. Only what is nearer by more than about a
// hundredth of the model's size hides a mark.
using MarkMask = std::vector<uint8_t>;
void mark_line(const Corner& from, const Corner& to, double pen_radius, const Canvas& canvas, MarkMask& mask);
// Marks a triangle with an outline, so that the smallest triangles are dots.
void mark_triangle(const std::array<Corner, 3>& corners, double pen_radius, const Canvas& canvas, MarkMask& mask);

// visible_behind: how much of a hidden mark shines through; 0..1.
void paint_marks(const MarkMask& mask, const Eigen::Vector3d& colour, float visible_behind, Canvas& canvas);

Picture average(const Canvas& canvas);

}  // namespace gim

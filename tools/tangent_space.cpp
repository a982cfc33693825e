#include "tools/tangent_space.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace gim {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

Vec3 triple(const std::vector<float>& values, size_t i, size_t width = 3) {
    return {values[i * width], values[i * width + 1], values[i * width + 2]};
}

Vec3 any_perpendicular(const Vec3& n) {
    const Vec3 axis = std::abs(n.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
    return n.cross(axis).normalized();
}

// A surface without a normal gets any normal, as in write_glb.
Vec3 normal_or_any(const std::vector<float>& normals, size_t i) {
    const Vec3 n = triple(normals, i);
    return n.squaredNorm() > 0 ? n : Vec3::UnitZ();
}

struct Frame {
    Vec3 normal = Vec3::Zero(), tangent = Vec3::Zero();
};

// Returns a direction in the frame that a renderer interpolates. That frame is not quite perpendicular, so this solves
// for the weights.
Vec3 local_direction(const Frame& frame, const Vec3& direction) {
    const Vec3 n = frame.normal.squaredNorm() > 0 ? frame.normal.normalized() : Vec3::UnitZ();
    const Vec3 t = frame.tangent.squaredNorm() > 0 ? frame.tangent.normalized() : any_perpendicular(n);
    Eigen::Matrix3d axes;
    axes << t, -n.cross(t), n;
    if (std::abs(axes.determinant()) < 1e-3) return Vec3::UnitZ();
    return axes.inverse() * direction;
}

// Calls f(texel, barycentric coordinates) for the texels of a plane in a triangle. The corners are in texels.
template <class F>
void for_each_texel(const std::array<Vec2, 3>& corner, const ImagePlane& plane, const F& f) {
    const auto twice_area = [](const Vec2& a, const Vec2& b, const Vec2& c) {
        return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    };
    const double area = twice_area(corner[0], corner[1], corner[2]);
    if (area == 0) return;
    constexpr double kRounding = 1e-6;  // texcoords are floats
    const Vec2 low = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]),
               high = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]);
    const double last_row = std::min(plane.rows - 1.0, std::floor(high.y() + kRounding)),
                 last_column = std::min(plane.columns - 1.0, std::floor(high.x() + kRounding));
    for (double row = std::max(0.0, std::ceil(low.y() - kRounding)); row <= last_row; ++row) {
        for (double column = std::max(0.0, std::ceil(low.x() - kRounding)); column <= last_column; ++column) {
            const Vec2 p(column, row);
            const Vec3 w = Vec3(twice_area(p, corner[1], corner[2]), twice_area(corner[0], p, corner[2]),
                                twice_area(corner[0], corner[1], p)) /
                           area;
            if (w.minCoeff() < -1e-4) continue;
            f(static_cast<size_t>(row) * plane.columns + static_cast<size_t>(column), w);
        }
    }
}

}  // namespace

std::vector<float> grid_tangents(const DecodedImage& image) {
    std::vector<float> tangents;
    tangents.reserve(size_t{4} * image.columns * image.rows);
    for (uint32_t row = 0; row < image.rows; ++row) {
        for (uint32_t column = 0; column < image.columns; ++column) {
            const size_t i = size_t{row} * image.columns + column;
            const Vec3 n = normal_or_any(image.grid_normals, i).normalized();
            const bool right = column + 1 < image.columns && image.is_defined(i + 1),
                       left = column > 0 && image.is_defined(i - 1);
            Vec3 along = Vec3::Zero();
            if (image.is_defined(i))
                along = triple(image.grid, right ? i + 1 : i) - triple(image.grid, left ? i - 1 : i);
            Vec3 t = along - n * n.dot(along);
            t = t.norm() > 1e-6 * along.norm() ? t.normalized() : any_perpendicular(n);
            for (const double x : {t.x(), t.y(), t.z(), -1.0}) tangents.push_back(static_cast<float>(x));
        }
    }
    return tangents;
}

std::vector<uint8_t> tangent_space_map(const DecodedImage& image, const std::vector<float>& tangents,
                                       const ImagePlane& normals) {
    std::vector<uint8_t> rgb(normals.values.size());
    for (size_t i = 0; i < rgb.size(); ++i) rgb[i] = i % 3 == 2 ? 255 : 128;
    const std::vector<uint32_t>& triangles = image.grid_triangles;
    for (size_t t = 0; t + 2 < triangles.size(); t += 3) {
        std::array<Vec2, 3> corner;
        std::array<Frame, 3> frames;
        for (size_t k = 0; k < 3; ++k) {
            const size_t sample = triangles[t + k];
            corner[k] = {double{image.grid_texcoords[2 * sample]} * (normals.columns - 1),
                         double{image.grid_texcoords[2 * sample + 1]} * (normals.rows - 1)};
            frames[k] = {normal_or_any(image.grid_normals, sample), triple(tangents, sample, 4)};
        }
        for_each_texel(corner, normals, [&](size_t texel, const Vec3& w) {
            Frame frame;
            for (int k = 0; k < 3; ++k) {
                frame.normal += w[k] * frames[static_cast<size_t>(k)].normal;
                frame.tangent += w[k] * frames[static_cast<size_t>(k)].tangent;
            }
            Vec3 local = local_direction(frame, triple(normals.values, texel));
            local.z() = std::max(local.z(), 0.0);  // a renderer shows nothing that looks inwards
            local = local.norm() > 1e-6 ? local.normalized() : Vec3::UnitZ();
            for (size_t k = 0; k < 3; ++k)
                rgb[3 * texel + k] = static_cast<uint8_t>(std::lround(127.5 * (1 + local[static_cast<int>(k)])));
        });
    }
    return rgb;
}

}  // namespace gim

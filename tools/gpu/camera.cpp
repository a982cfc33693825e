#include "tools/gpu/camera.h"

#include <cmath>

namespace gim {
namespace {

using Vector = std::array<double, 3>;

Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector unit(const Vector& a) {
    const double length = std::sqrt(dot(a, a));
    return {a[0] / length, a[1] / length, a[2] / length};
}

}  // namespace

ShaderView view_of(const Camera& camera, double pixel_error) {
    const Vector front = unit(minus(camera.target, camera.eye));
    const Vector right = unit(cross(front, camera.up)), up = cross(right, front);
    const double zoom = 1 / std::tan(camera.field_of_view / 2);
    const double far_part = camera.farthest / (camera.farthest - camera.nearest);

    // Rows of the matrix: x, y, depth and distance, each before the division by the distance.
    const auto row = [&](const Vector& axis, double scale, double offset) {
        return std::array<double, 4>{axis[0] * scale, axis[1] * scale, axis[2] * scale,
                                     offset - scale * dot(axis, camera.eye)};
    };
    const std::array<double, 4> rows[4] = {row(right, zoom * camera.height / camera.width, 0), row(up, zoom, 0),
                                           row(front, far_part, -far_part * camera.nearest), row(front, 1, 0)};
    ShaderView view;
    for (size_t r = 0; r < 4; ++r) {
        for (size_t c = 0; c < 4; ++c) view.world_to_clip[4 * c + r] = static_cast<float>(rows[r][c]);
    }
    for (size_t i = 0; i < 3; ++i) view.eye[i] = static_cast<float>(camera.eye[i]);
    view.eye[3] = static_cast<float>(camera.height * zoom / 2 / pixel_error);
    return view;
}

}  // namespace gim

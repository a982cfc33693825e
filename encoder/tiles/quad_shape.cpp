#include "encoder/tiles/quad_shape.h"

#include <algorithm>
#include <cmath>

namespace gim {

namespace {

constexpr double kAspectWeight = 0.3, kFlatnessWeight = 0.5;

double angle_at(const Vec3& apex, const Vec3& a, const Vec3& b) {
    const Vec3 u = a - apex, v = b - apex;
    return std::atan2(u.cross(v).norm(), u.dot(v));
}

// 1 at a right angle, 0 at a straight one, less where the corner is reflex.
double rightness(double angle) { return angle <= M_PI ? std::sin(angle) : M_PI - angle; }

}  // namespace

double quad_shape(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const double corners = rightness(angle_at(a, b, c) + angle_at(a, c, d)) + rightness(angle_at(b, c, a)) +
                           rightness(angle_at(c, d, a) + angle_at(c, a, b)) + rightness(angle_at(d, a, c));
    const double one_way = (b - a).norm() + (d - c).norm(), other_way = (c - b).norm() + (a - d).norm();
    const double longer = std::max(one_way, other_way);
    const double aspect = longer > 0 ? std::min(one_way, other_way) / longer : 0;
    const Vec3 first = (b - a).cross(c - a), second = (c - a).cross(d - a);
    const double areas = first.norm() * second.norm();
    const double flatness = areas > 0 ? first.dot(second) / areas : 1;
    return corners / 4 + kAspectWeight * (aspect - 1) + kFlatnessWeight * (flatness - 1);
}

}  // namespace gim

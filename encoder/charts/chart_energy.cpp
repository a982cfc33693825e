#include "encoder/charts/chart_energy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "encoder/surface/stretch.h"

namespace gim {

namespace {

// A sliver counts as if its height were kLeastHeight of its longest edge, or its area kLeastArea of a mean face's,
// whichever is less. So it neither locks the solver nor takes up room.
constexpr double kLeastHeight = 0.02, kLeastArea = 0.01;

MapElement element_of(const Vec3& a, const Vec3& b, const Vec3& c, double mean_area, double importance) {
    // Lay the longest edge along the x axis.
    const std::array<Vec3, 3> p{a, b, c};
    size_t first = 0;
    for (size_t i = 1; i < 3; ++i) {
        if ((p[(i + 1) % 3] - p[i]).squaredNorm() > (p[(first + 1) % 3] - p[first]).squaredNorm()) first = i;
    }
    const Vec3 edge = p[(first + 1) % 3] - p[first], other = p[(first + 2) % 3] - p[first];
    const double real_length = edge.norm(), length = std::max(real_length, 1e-3 * std::sqrt(mean_area));
    const double least_height = std::min(kLeastHeight * length, 2 * kLeastArea * mean_area / length);
    const double along = real_length > 0 ? other.dot(edge) / real_length : length / 2;
    const double height = std::max(real_length > 0 ? edge.cross(other).norm() / real_length : 0, least_height);
    std::array<Vec2, 3> q;
    q[first] = Vec2::Zero();
    q[(first + 1) % 3] = Vec2(length, 0);
    q[(first + 2) % 3] = Vec2(along, height);
    MapElement element;
    const double twice = twice_signed_area(q[0], q[1], q[2]);
    for (size_t i = 0; i < 3; ++i) {
        const Vec2 opposite = q[(i + 2) % 3] - q[(i + 1) % 3];
        element.gradient.col(static_cast<Eigen::Index>(i)) = Vec2(-opposite.y(), opposite.x()) / twice;
    }
    element.area = twice / 2;
    element.importance = importance;
    return element;
}

struct Singular {
    Eigen::Matrix2d u, v;  // rotations
    double s1 = 0, s2 = 0;
};

// Finds j = u diag(s1, s2) v^T for a positive determinant: u and v are rotations, and s1 >= s2 > 0.
Singular decompose(const Eigen::Matrix2d& j) {
    const double e = (j(0, 0) + j(1, 1)) / 2, f = (j(0, 0) - j(1, 1)) / 2;
    const double g = (j(1, 0) + j(0, 1)) / 2, h = (j(1, 0) - j(0, 1)) / 2;
    const double q = std::hypot(e, h), r = std::hypot(f, g);
    const double a1 = std::atan2(g, f), a2 = std::atan2(h, e);
    const double theta = (a2 - a1) / 2, phi = (a2 + a1) / 2;
    const auto rotation = [](double t) {
        Eigen::Matrix2d m;
        m << std::cos(t), -std::sin(t), std::sin(t), std::cos(t);
        return m;
    };
    return {rotation(phi), rotation(-theta), q + r, q - r};
}

}  // namespace

std::vector<MapElement> elements_of(const Mesh& mesh, const std::vector<double>& importance) {
    double mean_area = 0;
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) mean_area += face_area(mesh, f);
    mean_area = std::max(mean_area / static_cast<double>(mesh.triangles.size()), 1e-300);
    std::vector<MapElement> elements;
    elements.reserve(mesh.triangles.size());
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        elements.push_back(element_of(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], mean_area,
                                      importance.empty() ? 1 : importance[f]));
    }
    return elements;
}

void derivatives(const MapElement& e, const Eigen::Matrix2d& j, Vector6& gradient, Matrix6& hessian) {
    const Singular d = decompose(j);
    const double s1 = d.s1, s2 = d.s2, w = e.importance;
    const double p = s1 * s2, p3 = p * p * p;
    const Eigen::Vector2d slope(-w / (s1 * s1 * s1) + s2, -w / (s2 * s2 * s2) + s1);
    // Eigenvalues: twist, flip, and the 2x2 block of the two scalings.
    const double twist = std::max(0.0, 1 - w * (s1 * s1 - p + s2 * s2) / p3);
    const double flip = std::max(0.0, w * (s1 * s1 + p + s2 * s2) / p3 - 1);
    const double h11 = 3 * w / (s1 * s1 * s1 * s1), h22 = 3 * w / (s2 * s2 * s2 * s2);
    const double mean = (h11 + h22) / 2, radius = std::hypot((h11 - h22) / 2, 1.0);
    const double high = mean + radius, low = std::max(0.0, mean - radius);
    const double angle = 0.5 * std::atan2(2.0, h11 - h22);

    const auto u1 = d.u.col(0), u2 = d.u.col(1);
    const auto v1 = d.v.col(0), v2 = d.v.col(1);
    // Pulls a direction D in the space of 2x2 matrices back to the corners: corner i gets column i of (D * gradient).
    const auto pull = [&](const Eigen::Matrix2d& direction) {
        const Eigen::Matrix<double, 2, 3> x = direction * e.gradient;
        return Vector6(Eigen::Map<const Vector6>(x.data()));
    };
    const Eigen::Matrix2d scale1 = u1 * v1.transpose(), scale2 = u2 * v2.transpose();
    gradient = e.area * (slope[0] * pull(scale1) + slope[1] * pull(scale2));
    hessian.setZero();
    const auto add = [&](double value, const Eigen::Matrix2d& direction) {
        if (value <= 0) return;
        const Vector6 x = pull(direction);
        hessian += (e.area * value) * x * x.transpose();
    };
    add(twist, (u2 * v1.transpose() - u1 * v2.transpose()) * std::numbers::sqrt2 / 2);
    add(flip, (u2 * v1.transpose() + u1 * v2.transpose()) * std::numbers::sqrt2 / 2);
    add(high, std::cos(angle) * scale1 + std::sin(angle) * scale2);
    add(low, -std::sin(angle) * scale1 + std::cos(angle) * scale2);
}

}  // namespace gim

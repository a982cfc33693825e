#include "encoder/surface/stretch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace gim {

FaceMetric face_metric(const Vec3& a, const Vec3& b, const Vec3& c, double least_area) {
    const double area = 0.5 * (b - a).cross(c - a).norm();
    return {{(c - b).squaredNorm(), (a - c).squaredNorm(), (b - a).squaredNorm()}, 0.5 * std::max(area, least_area), 0};
}

double stretch_energy(const FaceMetric& metric, const Vec2& a, const Vec2& b, const Vec2& c) {
    const double d = twice_signed_area(a, b, c);
    if (!(d > 0)) return std::numeric_limits<double>::infinity();
    const Vec2 e0 = c - b, e1 = a - c, e2 = b - a;
    const double n = -metric.squared_length[0] * e1.dot(e2) - metric.squared_length[1] * e0.dot(e2) -
                     metric.squared_length[2] * e0.dot(e1);
    return (metric.weight / (d * d) + metric.squeeze) * n;
}

double stretch_efficiency(const Mesh& mesh, const std::vector<Vec2>& uv, double domain_area) {
    double energy = 0, area = 0;
    for (const Triangle& t : mesh.triangles) {
        const FaceMetric metric = face_metric(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], 0);
        if (metric.weight == 0) continue;
        energy += stretch_energy(metric, uv[t[0]], uv[t[1]], uv[t[2]]);
        area += 2 * metric.weight;
    }
    // energy / area is the mean squared stretch; its least possible value is area / domain_area.
    return area * area / (domain_area * energy);
}

namespace {

// Energy, gradient and Hessian of the star at x. The energy is infinite outside the kernel.
struct StarEnergy {
    double value = 0;
    Vec2 gradient = Vec2::Zero();
    Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
};

double star_value(const std::vector<StarTriangle>& star, const Vec2& x) {
    double value = 0;
    for (const StarTriangle& t : star) {
        const Vec2 a = t.p1 - x, b = t.p2 - x, e0 = t.p2 - t.p1;
        const double d = cross(a, b);
        if (!(d > 0)) return std::numeric_limits<double>::infinity();
        const double n =
            t.squared_length[0] * a.dot(b) - t.squared_length[1] * e0.dot(a) + t.squared_length[2] * e0.dot(b);
        value += (t.weight / (d * d) + t.squeeze) * n;
    }
    return value;
}

StarEnergy star_energy(const std::vector<StarTriangle>& star, const Vec2& x) {
    StarEnergy sum;
    double xx = 0, xy = 0, yy = 0;
    for (const StarTriangle& t : star) {
        const Vec2 a = t.p1 - x, b = t.p2 - x, e0 = t.p2 - t.p1;
        const double d = cross(a, b);
        if (!(d > 0)) {
            sum.value = std::numeric_limits<double>::infinity();
            return sum;
        }
        const double n =
            t.squared_length[0] * a.dot(b) - t.squared_length[1] * e0.dot(a) + t.squared_length[2] * e0.dot(b);
        const Vec2 dn = -t.squared_length[0] * (a + b) + (t.squared_length[1] - t.squared_length[2]) * e0;
        const Vec2 dd(-e0.y(), e0.x());
        const double r = 1 / d, w = t.weight * r * r, squeeze = 2 * t.squeeze * t.squared_length[0];
        sum.value += (w + t.squeeze) * n;
        sum.gradient += w * (dn - (2 * n * r) * dd) + t.squeeze * dn;
        const double k = 6 * n * r * r, m = 2 * r;
        xx += squeeze + w * (2 * t.squared_length[0] - 2 * m * dn.x() * dd.x() + k * dd.x() * dd.x());
        yy += squeeze + w * (2 * t.squared_length[0] - 2 * m * dn.y() * dd.y() + k * dd.y() * dd.y());
        xy += w * (-m * (dn.x() * dd.y() + dn.y() * dd.x()) + k * dd.x() * dd.y());
    }
    sum.hessian << xx, xy, xy, yy;
    return sum;
}

// Returns the Newton direction, with the Hessian's eigenvalues made positive.
Vec2 descent_direction(const StarEnergy& e) {
    const double xx = e.hessian(0, 0), xy = e.hessian(0, 1), yy = e.hessian(1, 1);
    const double mean = 0.5 * (xx + yy), radius = std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
    const double least = mean - radius, most = std::max(mean + radius, 0.0);
    const double shift = std::max(0.0, 1e-3 * most - least);
    const double a = xx + shift, c = yy + shift, det = a * c - xy * xy;
    if (!(det > 0)) return -e.gradient;
    return Vec2(-(c * e.gradient.x() - xy * e.gradient.y()) / det, -(a * e.gradient.y() - xy * e.gradient.x()) / det);
}

// Returns the Newton direction along one axis.
Vec2 descent_along(const StarEnergy& e, int axis) {
    const double curvature = e.hessian(axis, axis);
    Vec2 direction = Vec2::Zero();
    direction[axis] = curvature > 0 ? -e.gradient[axis] / curvature : -e.gradient[axis];
    return direction;
}

// Returns the longest step along `direction` that keeps every triangle counter-clockwise.
double longest_step(const std::vector<StarTriangle>& star, const Vec2& x, const Vec2& direction) {
    double longest = std::numeric_limits<double>::infinity();
    for (const StarTriangle& t : star) {
        const double d = cross(t.p1 - x, t.p2 - x);
        const Vec2 e0 = t.p2 - t.p1;
        const double slope = -e0.y() * direction.x() + e0.x() * direction.y();
        if (slope < 0) longest = std::min(longest, -d / slope);
    }
    return longest;
}

}  // namespace

double minimise_star(const std::vector<StarTriangle>& star, Vec2& x, int steps) {
    return descend_star(star, x, steps, kAnyDirection).after;
}

StarDescent descend_star(const std::vector<StarTriangle>& star, Vec2& x, int steps, int axis) {
    StarEnergy here = star_energy(star, x);
    const double start = here.value;
    for (int i = 0; i < steps && std::isfinite(here.value); ++i) {
        const Vec2 direction = axis == kAnyDirection ? descent_direction(here) : descent_along(here, axis);
        const double slope = direction.dot(here.gradient);
        if (!(slope < 0)) break;
        double step = std::min(1.0, 0.8 * longest_step(star, x, direction));
        bool moved = false;
        double reached = 0;
        for (int halving = 0; halving < 12; ++halving, step *= 0.5) {
            const Vec2 trial = x + step * direction;
            reached = star_value(star, trial);
            if (reached < here.value + 1e-4 * step * slope) {
                x = trial;
                moved = true;
                break;
            }
        }
        if (!moved) break;
        const double before = here.value;
        if (i + 1 == steps) return {start, reached};
        here = star_energy(star, x);
        if (before - here.value < 1e-6 * before) break;
    }
    return {start, here.value};
}

bool find_kernel_point(const std::vector<StarTriangle>& star, Vec2& x, double margin) {
    // Clips a box around the star to what lies left of every outer edge.
    Vec2 low = star.front().p1, high = low;
    for (const StarTriangle& t : star) {
        low = low.cwiseMin(t.p1).cwiseMin(t.p2);
        high = high.cwiseMax(t.p1).cwiseMax(t.p2);
    }
    const double beyond = margin * (high - low).maxCoeff();
    low.array() -= beyond;
    high.array() += beyond;
    std::vector<Vec2> polygon{low, Vec2(high.x(), low.y()), high, Vec2(low.x(), high.y())}, clipped;
    for (const StarTriangle& t : star) {
        clipped.clear();
        for (size_t i = 0; i < polygon.size(); ++i) {
            const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
            const double da = twice_signed_area(t.p1, t.p2, a), db = twice_signed_area(t.p1, t.p2, b);
            if (da >= 0) clipped.push_back(a);
            if ((da > 0 && db < 0) || (da < 0 && db > 0)) clipped.push_back(a + (b - a) * (da / (da - db)));
        }
        polygon.swap(clipped);
        if (polygon.size() < 3) return false;
    }
    Vec2 centroid = Vec2::Zero();
    double area = 0;
    for (size_t i = 1; i + 1 < polygon.size(); ++i) {
        const double a = twice_signed_area(polygon[0], polygon[i], polygon[i + 1]);
        centroid += a * (polygon[0] + polygon[i] + polygon[i + 1]);
        area += a;
    }
    if (!(area > 0)) return false;
    x = centroid / (3 * area);
    return std::isfinite(star_value(star, x));
}

}  // namespace gim

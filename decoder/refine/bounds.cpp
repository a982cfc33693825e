#include "decoder/refine/bounds.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "decoder/pyramid/vector3.h"

namespace gim {
namespace {

// A test in binary32 adds a few products of coordinates: each errs by 2^-24 of the largest. These are 8 and 64 times that.
constexpr double kOfCoordinates = 0x1p-21, kOfCosine = 0x1p-18;
// Rounding to binary32 errs by 2^-24.
constexpr double kOfRounding = 0x1p-22;
// Triangles whose area is below this share of the product of two edges. Above, the normal errs by less than 2^-20.
constexpr double kThin = 0x1p-30;
// Wider cones hardly ever cull, and their apex is far away. 168 degrees from end to end, as in meshoptimizer.
constexpr double kLeastCosine = 0.1;

// More hardly help: balls are then within 1 % of meshoptimizer's, and cones cull as much.
constexpr uint32_t kBallRounds = 4, kConeRounds = 10;

double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Point {
    double x[3];

    explicit Point(const float* p) : x{p[0], p[1], p[2]} {}
    Point(const double (&p)[3]) : x{p[0], p[1], p[2]} {}
};
Point mix(const Point& a, const Point& b, double t) {
    double p[3];
    for (int k = 0; k < 3; ++k) p[k] = a.x[k] + t * (b.x[k] - a.x[k]);
    return p;
}
double distance(const Point& a, const Point& b) {
    const double d[3] = {a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]};
    return std::sqrt(dot(d, d));
}
double largest_coordinate(const float* p) {
    return std::max({std::fabs(double{p[0]}), std::fabs(double{p[1]}), std::fabs(double{p[2]})});
}

float rounded_up(double x) { return static_cast<float>(x * (1 + kOfRounding)); }

// Moves a center towards the farthest point, by less each time, and keeps the best place: close to the center of the
// smallest ball around the points. Badoiu, Clarkson. Smaller core-sets for balls. 2003.
template <class PointAt>
void move_to_middle(size_t count, const PointAt& point_at, uint32_t rounds, float* center) {
    float at[3], best = FLT_MAX;
    std::copy_n(center, 3, at);
    for (uint32_t round = 0; round < rounds; ++round) {
        float farthest = -1;
        const float* far_point = at;
        for (size_t i = 0; i < count; ++i) {
            const float* p = point_at(i);
            const float distance = squared_distance(at, p);
            if (distance > farthest) farthest = distance, far_point = p;
        }
        if (farthest < best) {
            best = farthest;
            std::copy_n(at, 3, center);
        }
        const float share = 1.0f / static_cast<float>(round + 3);
        for (int k = 0; k < 3; ++k) at[k] += share * (far_point[k] - at[k]);
    }
}

}  // namespace

Ball ball_around(const QuadDomain& domain, std::span<const uint32_t> vertices) {
    float low[3] = {FLT_MAX, FLT_MAX, FLT_MAX}, high[3] = {-FLT_MAX, -FLT_MAX, -FLT_MAX};
    for (const uint32_t v : vertices) {
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], domain.value(v).position[k]);
            high[k] = std::max(high[k], domain.value(v).position[k]);
        }
    }
    Ball ball;
    for (int k = 0; k < 3; ++k) ball.center[k] = 0.5f * low[k] + 0.5f * high[k];
    move_to_middle(
        vertices.size(), [&](size_t i) { return domain.value(vertices[i]).position; }, kBallRounds, ball.center);
    const Point center(ball.center);
    double radius = 0;
    for (const uint32_t v : vertices) radius = std::max(radius, distance(center, Point(domain.value(v).position)));
    ball.radius = rounded_up(radius + kOfCoordinates * (largest_coordinate(ball.center) + radius));
    return ball;
}

void middle_of_normals(std::span<const Normal> normals, float* axis) {
    std::fill_n(axis, 3, 0.0f);
    for (const Normal& n : normals) {
        for (int k = 0; k < 3; ++k) axis[k] += n.x[k];
    }
    normalize(axis);
    move_to_middle(
        normals.size(), [&](size_t i) { return normals[i].x; }, kConeRounds, axis);
}

void include_ball(const Ball& other, Ball* ball) {
    const double needed = distance(Point(ball->center), Point(other.center)) + double{other.radius};
    if (needed > double{ball->radius}) ball->radius = rounded_up(needed);
}

Facing face_normal(const QuadDomain& domain, const uint32_t* vertices, double* normal) {
    double u[3], v[3];
    const float* p[3];
    for (int i = 0; i < 3; ++i) p[i] = domain.value(vertices[i]).position;
    for (int k = 0; k < 3; ++k) {
        u[k] = double{p[1][k]} - double{p[0][k]};
        v[k] = double{p[2][k]} - double{p[0][k]};
    }
    normal[0] = u[1] * v[2] - u[2] * v[1];
    normal[1] = u[2] * v[0] - u[0] * v[2];
    normal[2] = u[0] * v[1] - u[1] * v[0];
    const double squared = dot(normal, normal);
    if (squared == 0) return Facing::kNone;
    if (!(squared > kThin * kThin * dot(u, u) * dot(v, v))) return Facing::kUnsure;
    const double length = std::sqrt(squared);
    for (int k = 0; k < 3; ++k) normal[k] /= length;
    return Facing::kFine;
}

ConeFit::ConeFit(const float* axis, const Ball& around) : around_(around), axis_{axis[0], axis[1], axis[2]} {
    normalize(axis_);
}

bool ConeFit::add(const QuadDomain& domain, const uint32_t* vertices) {
    double normal[3];
    const Facing facing = face_normal(domain, vertices, normal);
    if (facing == Facing::kNone) return is_there_;
    const double cosine = dot(normal, Point(axis_).x);
    is_there_ = is_there_ && facing == Facing::kFine && cosine > kLeastCosine;
    if (!is_there_) return false;
    least_ = std::min(least_, cosine);
    // The apex must lie behind the plane of the triangle.
    const float* p = domain.value(vertices[0]).position;
    double from[3];
    for (int k = 0; k < 3; ++k) from[k] = double{around_.center[k]} - double{p[k]};
    back_ = std::max(back_, dot(from, normal) / cosine);
    return true;
}

Cone no_cone(const Ball& around) {
    Cone none;
    std::copy_n(around.center, 3, none.apex);
    return none;
}

Cone ConeFit::finish() const {
    const Cone none = no_cone(around_);
    const Point axis(axis_);
    const double length = std::sqrt(dot(axis.x, axis.x));
    if (!is_there_ || !(length > 0.5)) return none;
    // The axis as it was rounded is not quite of length 1.
    const double cosine = std::min(1.0, least_ / length);
    const double cutoff = length * std::sqrt(1 - cosine * cosine) + kOfCosine;
    // A shift along the axis by s leaves each plane by at least s * least_.
    const double coordinates = largest_coordinate(around_.center) + back_;
    const double slack = (kOfRounding * coordinates + kOfCosine * double{around_.radius}) / least_;
    if (!(cutoff < 1)) return none;
    Cone cone;
    cone.cutoff = rounded_up(cutoff);
    for (int k = 0; k < 3; ++k) {
        cone.axis[k] = axis_[k];
        cone.apex[k] = static_cast<float>(double{around_.center[k]} - axis.x[k] * (back_ + slack));
    }
    return cone;
}

// Both surfaces are linear where no edge of either crosses, so their distance is largest at a sample or where the diagonal
// of the cell crosses one of the samples' own. Which diagonals those have does not matter: where they do not cross, this
// only adds a point of the bound.
float cell_error(const QuadDomain& domain, const CoarseCell& cell) {
    const uint32_t size = cell.size;
    if (size == 1) return 0;
    const auto sample = [&](uint32_t row, uint32_t column) {
        return Point(domain.value(domain.vertex_at(cell.tile, cell.row + row, cell.column + column)).position);
    };
    const Point corner[4] = {sample(0, 0), sample(0, size), sample(size, size), sample(size, 0)};
    const double step = 1.0 / size;
    // A row of a coarse triangle runs from a side of the cell to the diagonal.
    double worst = 0, largest = 0;
    for (const Point& c : corner) {
        for (const double x : c.x) largest = std::max(largest, std::fabs(x));
    }
    const auto on_diagonal = [&](double y) {
        return cell.is_main ? mix(corner[0], corner[2], y) : mix(corner[1], corner[3], y);
    };
    for (uint32_t row = 0; row <= size; ++row) {
        const uint32_t crossing = cell.is_main ? row : size - row;
        const Point left = mix(corner[0], corner[3], row * step), right = mix(corner[1], corner[2], row * step);
        const Point middle = on_diagonal(row * step);
        for (uint32_t column = 0; column <= size; ++column) {
            const Point coarse = column < crossing ? mix(left, middle, static_cast<double>(column) / crossing)
                                 : column == crossing
                                     ? middle
                                     : mix(middle, right, static_cast<double>(column - crossing) / (size - crossing));
            worst = std::max(worst, distance(coarse, sample(row, column)));
        }
    }
    for (uint32_t row = 0; row < size; ++row) {
        const uint32_t column = cell.is_main ? row : size - 1 - row;
        const Point fine = cell.is_main ? mix(sample(row, column + 1), sample(row + 1, column), 0.5)
                                        : mix(sample(row, column), sample(row + 1, column + 1), 0.5);
        worst = std::max(worst, distance(on_diagonal((row + 0.5) * step), fine));
    }
    // Interpolation errs by a few 2^-53 of the coordinates.
    return rounded_up(worst + 0x1p-48 * largest);
}

}  // namespace gim

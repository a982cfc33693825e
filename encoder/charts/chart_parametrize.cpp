#include "encoder/charts/chart_parametrize.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "encoder/base/parallel.h"
#include "encoder/base/result.h"
#include "encoder/surface/stretch.h"
#include "encoder/surface/tutte.h"

namespace gim {

namespace {

// Slivers are treated as this high over their longest edge, or as having this part of a mean face's area, whichever is
// less: they neither lock the solver nor take up room.
constexpr double kLeastHeight = 0.02, kLeastArea = 0.01;
constexpr int kBarrierSteps = 60, kPatience = 20;

// The surface's side of a triangle: gradients of the three hat functions in its own plane, its area, its importance.
struct Element {
    Eigen::Matrix<double, 2, 3> gradient;
    double area = 0, importance = 1;
};

Element element_of(const Vec3& a, const Vec3& b, const Vec3& c, double mean_area, double importance) {
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
    Element element;
    const double twice = twice_signed_area(q[0], q[1], q[2]);
    for (size_t i = 0; i < 3; ++i) {
        const Vec2 opposite = q[(i + 2) % 3] - q[(i + 1) % 3];
        element.gradient.col(static_cast<Eigen::Index>(i)) = Vec2(-opposite.y(), opposite.x()) / twice;
    }
    element.area = twice / 2;
    element.importance = importance;
    return element;
}

Eigen::Matrix2d jacobian(const Element& e, const Vec2& a, const Vec2& b, const Vec2& c) {
    return a * e.gradient.col(0).transpose() + b * e.gradient.col(1).transpose() + c * e.gradient.col(2).transpose();
}

// importance/2 * (1/s1^2 + 1/s2^2) + s1 s2 in the singular values of j, times the area.
double energy(const Element& e, const Eigen::Matrix2d& j) {
    const double det = j.determinant();
    if (!(det > 0)) return std::numeric_limits<double>::infinity();
    return e.area * (0.5 * e.importance * j.squaredNorm() / (det * det) + det);
}

struct Singular {
    Eigen::Matrix2d u, v;  // rotations
    double s1 = 0, s2 = 0;
};

// j = u diag(s1, s2) v^T for a positive determinant: both factors rotations, s1 >= s2 > 0.
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

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Gradient and positive semi-definite part of the Hessian over (a, b, c).
void derivatives(const Element& e, const Eigen::Matrix2d& j, Vector6& gradient, Matrix6& hessian) {
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
    // Directions in the space of 2x2 matrices, pulled back to the corners: column i of (D * gradient).
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

// ---- start --------------------------------------------------------------------------------------------------------

bool all_upright(const Mesh& mesh, const std::vector<Vec2>& uv) {
    return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
        const double longest = std::max({(uv[t[1]] - uv[t[0]]).squaredNorm(), (uv[t[2]] - uv[t[1]]).squaredNorm(),
                                         (uv[t[0]] - uv[t[2]]).squaredNorm()});
        return twice_signed_area(uv[t[0]], uv[t[1]], uv[t[2]]) > 1e-3 * longest;
    });
}

std::vector<Vec2> projected(const Mesh& mesh) {
    Vec3 normal = Vec3::Zero();
    for (const Triangle& t : mesh.triangles)
        normal += (mesh.positions[t[1]] - mesh.positions[t[0]]).cross(mesh.positions[t[2]] - mesh.positions[t[0]]);
    if (!(normal.norm() > 0)) normal = Vec3::UnitZ();
    normal.normalize();
    const Vec3 x = normal.unitOrthogonal(), y = normal.cross(x);
    std::vector<Vec2> uv;
    uv.reserve(mesh.positions.size());
    for (const Vec3& p : mesh.positions) uv.emplace_back(x.dot(p), y.dot(p));
    return uv;
}

// Tutte's map to a circle: injective on any disk, as no two border vertices are on a line with a third.
bool tutte(const Chart& chart, double total_area, std::vector<Vec2>& uv) {
    const Mesh& mesh = chart.mesh;
    const double radius = std::sqrt(total_area / std::numbers::pi);
    uv.assign(mesh.positions.size(), Vec2::Zero());
    std::vector<uint8_t> fixed(uv.size(), 0);
    std::vector<double> along(chart.loop.size() + 1, 0);
    for (size_t i = 0; i < chart.loop.size(); ++i) {
        const Vec3& a = mesh.positions[chart.loop[i]];
        const Vec3& b = mesh.positions[chart.loop[(i + 1) % chart.loop.size()]];
        along[i + 1] = along[i] + (b - a).norm();
    }
    constexpr double kUniform = 0.05;  // keeps coincident neighbours apart
    for (size_t i = 0; i < chart.loop.size(); ++i) {
        const double even = static_cast<double>(i) / static_cast<double>(chart.loop.size());
        const double part = along.back() > 0 ? (1 - kUniform) * along[i] / along.back() + kUniform * even : even;
        uv[chart.loop[i]] = radius * Vec2(std::cos(2 * std::numbers::pi * part), std::sin(2 * std::numbers::pi * part));
        fixed[chart.loop[i]] = 1;
    }
    // The edges of an interior vertex all leave it as half-edges.
    std::vector<std::array<uint32_t, 2>> arcs;
    for (const Triangle& t : mesh.triangles) {
        for (size_t i = 0; i < 3; ++i) arcs.push_back({t[i], t[(i + 1) % 3]});
    }
    return solve_tutte(arcs, fixed, uv);
}

// ---- border -------------------------------------------------------------------------------------------------------

// Cells about as large as an edge of a closed polygon, listing the edges whose boxes meet them.
class EdgeGrid {
  public:
    EdgeGrid(const std::vector<Vec2>& polygon, double margin) : polygon_(polygon), low_(polygon[0]) {
        Vec2 high = low_;
        double length = 0;
        for (size_t i = 0; i < size(); ++i) {
            low_ = low_.cwiseMin(polygon_[i]);
            high = high.cwiseMax(polygon_[i]);
            length += (end(i) - polygon_[i]).norm();
        }
        const Vec2 extent = (high - low_).cwiseMax(1e-300);
        cell_ = std::max({length / static_cast<double>(size()), extent.maxCoeff() / 512, 1e-300});
        columns_ = static_cast<size_t>(extent.x() / cell_) + 1;
        rows_ = static_cast<size_t>(extent.y() / cell_) + 1;
        cells_.resize(columns_ * rows_);
        for (uint32_t i = 0; i < size(); ++i) {
            visit(polygon_[i].cwiseMin(end(i)) - Vec2(margin, margin),
                  polygon_[i].cwiseMax(end(i)) + Vec2(margin, margin), [&](size_t cell) { cells_[cell].push_back(i); });
        }
    }

    size_t size() const { return polygon_.size(); }
    const Vec2& begin(size_t i) const { return polygon_[i]; }
    const Vec2& end(size_t i) const { return polygon_[(i + 1) % size()]; }
    const std::vector<uint32_t>& edges_in(size_t cell) const { return cells_[cell]; }
    size_t cell_count() const { return cells_.size(); }

    // Calls body(cell) for every cell that a box meets.
    template <class Body>
    void visit(const Vec2& low, const Vec2& high, const Body& body) const {
        const auto clamp = [&](double x, size_t count) {
            return static_cast<size_t>(std::clamp(std::floor(x / cell_), 0.0, static_cast<double>(count - 1)));
        };
        for (size_t row = clamp(low.y() - low_.y(), rows_); row <= clamp(high.y() - low_.y(), rows_); ++row) {
            for (size_t column = clamp(low.x() - low_.x(), columns_); column <= clamp(high.x() - low_.x(), columns_);
                 ++column)
                body(row * columns_ + column);
        }
    }

  private:
    const std::vector<Vec2>& polygon_;
    Vec2 low_;
    double cell_ = 0;
    size_t columns_ = 0, rows_ = 0;
    std::vector<std::vector<uint32_t>> cells_;
};

bool segments_meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
    const double abc = twice_signed_area(a, b, c), abd = twice_signed_area(a, b, d);
    const double cda = twice_signed_area(c, d, a), cdb = twice_signed_area(c, d, b);
    const bool boxes_meet = std::max(std::min(a.x(), b.x()), std::min(c.x(), d.x())) <=
                                std::min(std::max(a.x(), b.x()), std::max(c.x(), d.x())) &&
                            std::max(std::min(a.y(), b.y()), std::min(c.y(), d.y())) <=
                                std::min(std::max(a.y(), b.y()), std::max(c.y(), d.y()));
    return boxes_meet && !(abc > 0 && abd > 0) && !(abc < 0 && abd < 0) && !(cda > 0 && cdb > 0) &&
           !(cda < 0 && cdb < 0);
}

// Keeps a border from running into itself: weight * (reach / d - 1)^2 for every border vertex and border edge that are
// closer than `reach` in the plane but not along the border.
class BorderBarrier : public BorderForce {
  public:
    BorderBarrier(const Chart& chart, double weight) : loop_(chart.loop), weight_(weight) {
        std::vector<double> edge(loop_.size());
        for (size_t i = 0; i < edge.size(); ++i) {
            edge[i] = (chart.mesh.positions[loop_[(i + 1) % edge.size()]] - chart.mesh.positions[loop_[i]]).norm();
        }
        along_.assign(edge.size() + 1, 0);
        for (size_t i = 0; i < edge.size(); ++i) along_[i + 1] = along_[i] + edge[i];
        reach_ = 0.25 * along_.back() / static_cast<double>(edge.size());
    }

    // Calls body(pair, distance, direction from edge to vertex) for every close pair. False when the border crosses
    // itself.
    template <class Body>
    bool for_each_close(const std::vector<Vec2>& uv, const Body& body) const {
        std::vector<Vec2> polygon;
        polygon.reserve(loop_.size());
        for (const uint32_t v : loop_) polygon.push_back(uv[v]);
        if (find_crossing(polygon)) return false;
        const EdgeGrid grid(polygon, reach_);
        std::vector<uint32_t> seen(loop_.size(), kNone);
        for (uint32_t i = 0; i < loop_.size(); ++i) {
            grid.visit(polygon[i], polygon[i], [&](size_t cell) {
                for (const uint32_t e : grid.edges_in(cell)) {
                    if (seen[e] == i || near_along(i, e)) continue;
                    seen[e] = i;
                    const Vec2 edge = grid.end(e) - grid.begin(e);
                    const double length2 = edge.squaredNorm();
                    const double t =
                        length2 > 0 ? std::clamp((polygon[i] - grid.begin(e)).dot(edge) / length2, 0.0, 1.0) : 0;
                    const Vec2 apart = polygon[i] - grid.begin(e) - t * edge;
                    const double d = apart.norm();
                    if (d >= reach_ || d == 0) continue;
                    body(std::array{loop_[i], loop_[e], loop_[(e + 1) % loop_.size()]}, t, d, Vec2(apart / d));
                }
            });
        }
        return true;
    }

    double energy(const std::vector<Vec2>& uv) const override {
        double sum = 0;
        const bool simple = for_each_close(uv, [&](const auto&, double, double d, const Vec2&) {
            sum += weight_ * (reach_ / d - 1) * (reach_ / d - 1);
        });
        return simple ? sum : std::numeric_limits<double>::infinity();
    }

    void derivatives(const std::vector<Vec2>& uv, const Add& add) const override {
        for_each_close(uv, [&](const std::array<uint32_t, 3>& v, double t, double d, const Vec2& n) {
            const double first = -2 * weight_ * (reach_ / d - 1) * reach_ / (d * d);
            const double second =
                weight_ * (2 * reach_ * reach_ / (d * d * d * d) + 4 * (reach_ / d - 1) * reach_ / (d * d * d));
            const std::array<double, 3> part{1, t - 1, -t};
            for (size_t k = 0; k < 3; ++k) {
                add(v[k], Vec2(first * part[k] * n),
                    Eigen::Matrix2d(2 * std::abs(part[k]) * second *
                                    (n * n.transpose() + 0.1 * Eigen::Matrix2d::Identity())));
            }
        });
    }

  private:
    bool near_along(size_t vertex, size_t edge) const {
        const double total = along_.back();
        const auto gap = [&](size_t a, size_t b) {
            const double d = std::abs(along_[a] - along_[b]);
            return std::min(d, total - d);
        };
        return std::min(gap(vertex, edge), gap(vertex, edge + 1)) < 3 * reach_;
    }

    const std::vector<uint32_t>& loop_;
    double weight_, reach_ = 0;
    std::vector<double> along_;
};

// ---- Newton -------------------------------------------------------------------------------------------------------

class Newton {
  public:
    // `barrier` may be null: the border is free to run over itself then.
    Newton(const Mesh& mesh, const std::vector<Element>& elements, const BorderForce* barrier, std::vector<Vec2>& uv)
        : mesh_(mesh),
          elements_(elements),
          barrier_(barrier),
          uv_(uv),
          hessian_(2 * size(), 2 * size()),
          gradient_(2 * size()) {
        for (const Triangle& t : mesh_.triangles) {
            // The lower half of the pattern; values are filled in by slot.
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    for (int a = 0; a < 2; ++a)
                        for (int b = 0; b < 2; ++b) entries_.emplace_back(2 * t[i] + a, 2 * t[j] + b, 1.0);
        }
        for (Eigen::Index k = 0; k < 2 * size(); ++k) entries_.emplace_back(k, k, 1.0);
        hessian_.setFromTriplets(entries_.begin(), entries_.end());
        slots_.reserve(36 * mesh_.triangles.size());
        for (const auto& entry : entries_)
            slots_.push_back(&hessian_.coeffRef(entry.row(), entry.col()) - hessian_.valuePtr());
        entries_.clear();
        entries_.shrink_to_fit();
        solver_.analyzePattern(hessian_);
    }

    // Gives up after kPatience steps when the energy is still above `hopeless`.
    double run(int most_steps, double tolerance, double hopeless = std::numeric_limits<double>::infinity()) {
        double here = total(uv_);
        int small_gains = 0;
        for (int step = 0; step < most_steps && std::isfinite(here); ++step) {
            assemble();
            if (!solve()) break;
            const double slope = gradient_.dot(direction_);
            if (!(slope < 0)) break;
            const double reached = search(here, slope);
            const double gain = here - reached;
            here = reached;
            // A border in contact with itself holds the whole step back now and then.
            small_gains = gain <= tolerance * here ? small_gains + 1 : 0;
            if (small_gains > (barrier_ ? 5 : 0) || (step >= kPatience && here > hopeless)) break;
        }
        return here;
    }

  private:
    Eigen::Index size() const { return static_cast<Eigen::Index>(uv_.size()); }

    double total(const std::vector<Vec2>& uv) const {
        double sum = 0;
        for (size_t f = 0; f < elements_.size(); ++f) {
            const Triangle& t = mesh_.triangles[f];
            sum += energy(elements_[f], jacobian(elements_[f], uv[t[0]], uv[t[1]], uv[t[2]]));
            if (!std::isfinite(sum)) return sum;
        }
        return barrier_ ? sum + barrier_->energy(uv) : sum;
    }

    void assemble() {
        gradient_.setZero();
        double* values = hessian_.valuePtr();
        std::fill(values, values + hessian_.nonZeros(), 0.0);
        size_t slot = 0;
        Vector6 g;
        Matrix6 h;
        for (size_t f = 0; f < elements_.size(); ++f) {
            const Triangle& t = mesh_.triangles[f];
            derivatives(elements_[f], jacobian(elements_[f], uv_[t[0]], uv_[t[1]], uv_[t[2]]), g, h);
            for (int i = 0; i < 3; ++i) {
                gradient_[2 * t[i]] += g[2 * i];
                gradient_[2 * t[i] + 1] += g[2 * i + 1];
                for (int j = 0; j < 3; ++j)
                    for (int a = 0; a < 2; ++a)
                        for (int b = 0; b < 2; ++b) values[slots_[slot++]] += h(2 * i + a, 2 * j + b);
            }
        }
        const size_t diagonal = slot;
        if (barrier_) {
            barrier_->derivatives(uv_, [&](uint32_t v, const Vec2& gradient, const Eigen::Matrix2d& block) {
                for (int a = 0; a < 2; ++a) {
                    gradient_[2 * v + a] += gradient[a];
                    for (int b = 0; b < 2; ++b) hessian_.coeffRef(2 * v + a, 2 * v + b) += block(a, b);
                }
            });
        }
        // Rigid motions are free; a trace of identity makes the matrix definite.
        double trace = 0;
        for (size_t k = diagonal; k < slots_.size(); ++k) trace += values[slots_[k]];
        const double shift = 1e-7 * trace / static_cast<double>(slots_.size() - diagonal);
        for (size_t k = diagonal; k < slots_.size(); ++k) values[slots_[k]] += shift;
    }

    bool solve() {
        solver_.factorize(hessian_);
        if (solver_.info() != Eigen::Success) return false;
        direction_ = solver_.solve(-gradient_);
        return direction_.allFinite();
    }

    // Backtracks from the longest step that keeps all triangles upright. Returns the energy reached.
    double search(double here, double slope) {
        double step = 1;
        const auto direction = [&](uint32_t v) { return Vec2(direction_[2 * v], direction_[2 * v + 1]); };
        for (const Triangle& t : mesh_.triangles) {
            const Vec2 p = uv_[t[1]] - uv_[t[0]], q = uv_[t[2]] - uv_[t[0]];
            const Vec2 dp = direction(t[1]) - direction(t[0]), dq = direction(t[2]) - direction(t[0]);
            // area(s) = c + b s + a s^2 > 0
            const double c = cross(p, q), b = cross(dp, q) + cross(p, dq), a = cross(dp, dq);
            const double disc = b * b - 4 * a * c;
            if (disc < 0) continue;
            // The smaller positive root, without cancellation.
            const double half = -0.5 * (b + std::copysign(std::sqrt(disc), b));
            for (const double root : {half / a, c / half}) {
                if (root > 0 && std::isfinite(root)) step = std::min(step, 0.9 * root);
            }
        }
        std::vector<Vec2> trial(uv_.size());
        for (int halving = 0; halving < 25; ++halving, step *= 0.5) {
            for (uint32_t v = 0; v < uv_.size(); ++v) trial[v] = uv_[v] + step * direction(v);
            const double reached = total(trial);
            if (reached <= here + 1e-4 * step * slope) {
                uv_.swap(trial);
                return reached;
            }
        }
        return here;
    }

    const Mesh& mesh_;
    const std::vector<Element>& elements_;
    const BorderForce* barrier_;
    std::vector<Vec2>& uv_;
    std::vector<Eigen::Triplet<double>> entries_;
    Eigen::SparseMatrix<double> hessian_;
    std::vector<std::ptrdiff_t> slots_;  // 36 per triangle, then the diagonal
    Eigen::VectorXd gradient_, direction_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

std::vector<Element> elements_of(const Mesh& mesh, const std::vector<double>& importance) {
    double mean_area = 0;
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) mean_area += face_area(mesh, f);
    mean_area = std::max(mean_area / static_cast<double>(mesh.triangles.size()), 1e-300);
    std::vector<Element> elements;
    elements.reserve(mesh.triangles.size());
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        elements.push_back(element_of(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], mean_area,
                                      importance.empty() ? 1 : importance[f]));
    }
    return elements;
}

void measure_map(const Mesh& mesh, const std::vector<Element>& elements, ChartMap& map) {
    map.energy = map.area = 0;
    for (size_t f = 0; f < elements.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        const double area = twice_signed_area(map.uv[t[0]], map.uv[t[1]], map.uv[t[2]]) / 2;
        map.area += area;
        map.energy += energy(elements[f], jacobian(elements[f], map.uv[t[0]], map.uv[t[1]], map.uv[t[2]])) - area;
    }
}

}  // namespace

std::vector<Vec2> border_of(const Chart& chart, const std::vector<Vec2>& uv) {
    std::vector<Vec2> border;
    border.reserve(chart.loop.size());
    for (const uint32_t v : chart.loop) border.push_back(uv[v]);
    return border;
}

void measure_map(const Chart& chart, const std::vector<double>& importance, ChartMap& map) {
    measure_map(chart.mesh, elements_of(chart.mesh, importance), map);
}

ChartMap relax_chart(const Chart& chart, const std::vector<double>& importance, ChartMap map, double area_weight,
                     const BorderForce& force, const ChartParametrizeOptions& options) {
    const std::vector<Element> elements = elements_of(chart.mesh, importance);
    // Less weight on the area is more on all the rest.
    std::vector<Element> pressed = elements;
    for (Element& e : pressed) e.importance /= area_weight;
    Newton(chart.mesh, pressed, &force, map.uv).run(options.most_steps, options.tolerance);
    measure_map(chart.mesh, elements, map);
    return map;
}

Result<ChartMap> parametrize_chart(const Chart& chart, const std::vector<double>& importance,
                                   const ChartParametrizeOptions& options) {
    const Mesh& mesh = chart.mesh;
    std::vector<Element> elements = elements_of(mesh, importance);
    double total_area = 0;
    for (const Element& e : elements) total_area += e.area;
    ChartMap map;
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) map.surface += face_area(mesh, f);
    const auto border_crossing = [&] { return find_crossing(border_of(chart, map.uv)); };
    const auto measure = [&] { measure_map(mesh, elements, map); };
    const auto start_from_circle = [&] { return tutte(chart, total_area, map.uv); };
    const Error unsolvable{Stage::kParametrize, "a chart of " + std::to_string(mesh.triangles.size()) +
                                                    " triangles could not be flattened; is it a disk?"};
    map.uv = projected(mesh);
    if (!all_upright(mesh, map.uv) && !start_from_circle()) return unsolvable;
    Newton(mesh, elements, nullptr, map.uv).run(options.most_steps, options.tolerance);
    measure();
    if (const auto crossing = border_crossing()) {
        const auto face_at = [&](uint32_t edge) {
            const uint32_t v = chart.loop[edge], w = chart.loop[(edge + 1) % chart.loop.size()];
            const auto found = std::find_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
                return (t[0] == v && t[1] == w) || (t[1] == v && t[2] == w) || (t[2] == v && t[0] == w);
            });
            return static_cast<uint32_t>(found - mesh.triangles.begin());
        };
        map.crossing = std::array{face_at((*crossing)[0]), face_at((*crossing)[1])};
        const double overlapping = map.energy * map.area;
        // Once more, from a map that does not overlap and with the border kept from meeting itself.
        if (!start_from_circle()) return unsolvable;
        const BorderBarrier barrier(chart, total_area / static_cast<double>(mesh.triangles.size()));
        // The energy is twice sqrt(E A) at best: a strain of 1.5 has 1.2 times as much.
        Newton(mesh, elements, &barrier, map.uv)
            .run(std::min(options.most_steps, kBarrierSteps), options.tolerance, 2.5 * std::sqrt(overlapping));
        measure();
        map.strain = std::max(1.0, map.energy * map.area / overlapping);
        map.overlaps = border_crossing().has_value();
    }
    // Newton stopped a little early, perhaps: the last of the scale is exact.
    const double scale = std::pow(map.energy / map.area, 0.25);
    if (std::isfinite(scale) && scale > 0) {
        for (Vec2& p : map.uv) p *= scale;
        map.energy /= scale * scale, map.area *= scale * scale;
    }
    uint64_t flipped = 0;
    for (const Triangle& t : mesh.triangles)
        flipped += !(twice_signed_area(map.uv[t[0]], map.uv[t[1]], map.uv[t[2]]) > 0);
    if (flipped > 0) map.overlaps = true;
    return map;
}

Result<std::vector<ChartMap>> parametrize_charts(const std::vector<Chart>& charts,
                                                 const std::vector<double>& importance,
                                                 const ChartParametrizeOptions& options, const Progress& progress) {
    std::vector<ChartMap> maps(charts.size());
    std::vector<std::string> errors(charts.size());
    if (progress) progress(Stage::kParametrize, 0);
    parallel_blocks(charts.size(), 1, options.threads, [&](size_t, size_t begin, size_t end) {
        for (size_t c = begin; c < end; ++c) {
            std::vector<double> own;
            if (!importance.empty()) {
                for (const uint32_t f : charts[c].source_face) own.push_back(importance[f]);
            }
            auto map = parametrize_chart(charts[c], own, options);
            if (map.ok()) {
                maps[c] = std::move(map.value());
            } else {
                errors[c] = map.error().message;
            }
        }
    });
    for (size_t c = 0; c < errors.size(); ++c) {
        if (!errors[c].empty()) return Error{Stage::kParametrize, "chart " + std::to_string(c) + ": " + errors[c]};
    }
    return maps;
}

double stretch_efficiency(const std::vector<Chart>& charts, const std::vector<ChartMap>& maps) {
    double energy_sum = 0, area = 0, domain = 0;
    for (size_t c = 0; c < charts.size(); ++c) {
        const Mesh& mesh = charts[c].mesh;
        const std::vector<Vec2>& uv = maps[c].uv;
        for (const Triangle& t : mesh.triangles) {
            domain += twice_signed_area(uv[t[0]], uv[t[1]], uv[t[2]]) / 2;
            const FaceMetric metric = face_metric(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], 0);
            if (metric.weight == 0) continue;
            energy_sum += stretch_energy(metric, uv[t[0]], uv[t[1]], uv[t[2]]);
            area += 2 * metric.weight;
        }
    }
    return area * area / (domain * energy_sum);
}

std::optional<std::array<uint32_t, 2>> find_crossing(const std::vector<Vec2>& polygon) {
    const size_t n = polygon.size();
    if (n < 4) return std::nullopt;
    const EdgeGrid grid(polygon, 0);
    for (size_t cell = 0; cell < grid.cell_count(); ++cell) {
        const std::vector<uint32_t>& edges = grid.edges_in(cell);
        for (size_t k = 0; k < edges.size(); ++k) {
            for (size_t l = 0; l < k; ++l) {
                const uint32_t i = edges[l], j = edges[k];                   // i < j
                if (i + 1 == j || (i == 0 && size_t{j} + 1 == n)) continue;  // neighbours share a corner
                if (segments_meet(grid.begin(i), grid.end(i), grid.begin(j), grid.end(j))) return std::array{i, j};
            }
        }
    }
    return std::nullopt;
}

}  // namespace gim

#include "encoder/charts/border_barrier.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "encoder/surface/stretch.h"

namespace gim {

namespace {

// A grid over a closed polygon. Its cells are about as large as an edge and list the edges whose boxes meet them.
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

}  // namespace

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

BorderBarrier::BorderBarrier(const Chart& chart, double weight) : loop_(chart.loop), weight_(weight) {
    std::vector<double> edge(loop_.size());
    for (size_t i = 0; i < edge.size(); ++i) {
        edge[i] = (chart.mesh.positions[loop_[(i + 1) % edge.size()]] - chart.mesh.positions[loop_[i]]).norm();
    }
    along_.assign(edge.size() + 1, 0);
    for (size_t i = 0; i < edge.size(); ++i) along_[i + 1] = along_[i] + edge[i];
    reach_ = 0.25 * along_.back() / static_cast<double>(edge.size());
}

template <class Body>
bool BorderBarrier::for_each_close(const std::vector<Vec2>& uv, const Body& body) const {
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

bool BorderBarrier::near_along(size_t vertex, size_t edge) const {
    const double total = along_.back();
    const auto gap = [&](size_t a, size_t b) {
        const double d = std::abs(along_[a] - along_[b]);
        return std::min(d, total - d);
    };
    return std::min(gap(vertex, edge), gap(vertex, edge + 1)) < 3 * reach_;
}

double BorderBarrier::energy(const std::vector<Vec2>& uv) const {
    double sum = 0;
    const bool simple = for_each_close(
        uv, [&](const auto&, double, double d, const Vec2&) { sum += weight_ * (reach_ / d - 1) * (reach_ / d - 1); });
    return simple ? sum : std::numeric_limits<double>::infinity();
}

void BorderBarrier::derivatives(const std::vector<Vec2>& uv, const Add& add) const {
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

}  // namespace gim

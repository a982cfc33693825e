#include "encoder/charts/inflate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>

#include "encoder/base/parallel.h"
#include "encoder/charts/border_barrier.h"
#include "encoder/surface/stretch.h"

namespace gim {

namespace {

constexpr std::array<std::array<int, 2>, 8> kAround{
    {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};

// Shares out the image's samples among the charts.
class Shares {
  public:
    explicit Shares(const Packing& packing) : width_(packing.width), height_(packing.height) {
        const size_t count = size_t{packing.width} * packing.height;
        owner_.assign(count, kNone);
        wall_.assign(count, 0);
        taken_.assign(count, 0);
        nearest_.assign(count, kNone);
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        for (uint32_t c = 0; c < packing.charts.size(); ++c) add_chart(packing.charts[c], c, queue);
        spread(queue);
        raise_walls();
    }

    // Returns whether a chart may define the sample.
    bool open_to(uint32_t chart, int64_t column, int64_t row) const {
        if (column < 0 || row < 0 || column >= width_ || row >= height_) return false;
        const size_t i = number(column, row);
        return owner_[i] == chart && !wall_[i];
    }

  private:
    struct Border {
        int64_t column, row;
        uint32_t along, length;  // of the chart's border
    };
    // Nearest first; ties by number.
    using Entry = std::array<int64_t, 3>;  // squared distance, sample, border sample

    size_t number(int64_t column, int64_t row) const { return static_cast<size_t>(row * width_ + column); }

    template <class Queue>
    void add_chart(const PlacedChart& placed, uint32_t c, Queue& queue) {
        const SampleMask& mask = placed.chart.mask;
        for (uint32_t i = 0; i < mask.defined.size(); ++i) {
            if (!mask.defined[i]) continue;
            const size_t k = number(int64_t{placed.column} + i % mask.width, int64_t{placed.row} + i / mask.width);
            owner_[k] = c, taken_[k] = 1;
        }
        const std::vector<uint32_t> loop = trace_borders(mask)[0];
        for (uint32_t k = 0; k < loop.size(); ++k) {
            const Border border{int64_t{placed.column} + loop[k] % mask.width,
                                int64_t{placed.row} + loop[k] / mask.width, k, static_cast<uint32_t>(loop.size())};
            const size_t at = number(border.column, border.row);
            nearest_[at] = static_cast<uint32_t>(borders_.size());
            queue.push({0, static_cast<int64_t>(at), nearest_[at]});
            borders_.push_back(border);
        }
    }

    // Gives every free sample to the border sample that is nearest, or nearly so.
    template <class Queue>
    void spread(Queue& queue) {
        std::vector<uint8_t> done(owner_.size(), 0);
        while (!queue.empty()) {
            const Entry entry = queue.top();
            queue.pop();
            const auto at = static_cast<size_t>(entry[1]);
            if (done[at]) continue;
            done[at] = 1;
            const auto b = static_cast<uint32_t>(entry[2]);
            nearest_[at] = b;
            owner_[at] = owner_[number(borders_[b].column, borders_[b].row)];
            for (const auto& step : kAround) {
                const int64_t column = entry[1] % width_ + step[0], row = entry[1] / width_ + step[1];
                if (column < 0 || row < 0 || column >= width_ || row >= height_) continue;
                const size_t next = number(column, row);
                if (done[next] || taken_[next]) continue;
                const int64_t dx = column - borders_[b].column, dy = row - borders_[b].row;
                queue.push({dx * dx + dy * dy, static_cast<int64_t>(next), b});
            }
        }
    }

    // Returns whether two border samples are on the banks of an inlet: near each other, but not along the border.
    bool are_banks(uint32_t a, uint32_t b) const {
        constexpr double kDetour = 2, kSlack = 4;
        const Border &p = borders_[a], &q = borders_[b];
        const uint32_t gap = p.along > q.along ? p.along - q.along : q.along - p.along;
        const double apart = std::hypot(static_cast<double>(p.column - q.column), static_cast<double>(p.row - q.row));
        return std::min(gap, p.length - gap) > kDetour * apart + kSlack;
    }

    // Makes one of two neighbours gutter if they belong to different charts or banks. Diagonals only count for banks.
    void raise_walls() {
        for (int64_t row = 0; row < height_; ++row) {
            for (int64_t column = 0; column < width_; ++column) {
                for (size_t k = 0; k < 8; ++k) {
                    if (k == 2 || k == 3 || k == 6 || k == 7) continue;  // every pair once
                    const int64_t x = column + kAround[k][0], y = row + kAround[k][1];
                    if (x < 0 || x >= width_ || y >= height_) continue;
                    const size_t a = number(column, row), b = number(x, y);
                    if (wall_[a] || wall_[b] || (taken_[a] && taken_[b])) continue;
                    const bool strangers = owner_[a] != owner_[b];
                    if (strangers
                            ? k > 1
                            : nearest_[a] == kNone || nearest_[b] == kNone || !are_banks(nearest_[a], nearest_[b]))
                        continue;
                    wall_[taken_[a] ? b : a] = 1;
                }
            }
        }
    }

    int64_t width_, height_;
    std::vector<uint32_t> owner_, nearest_;
    std::vector<uint8_t> wall_, taken_;
    std::vector<Border> borders_;
};

// Knows how far a point is from the nearest sample that a chart must not define. Beyond that sample, it is less than 0.
class Territory {
  public:
    Territory(const Shares& shares, uint32_t chart, const PlacedChart& placed) {
        constexpr int64_t kReach = 24;  // as far as a chart may grow
        column_ = int64_t{placed.column} - kReach;
        row_ = int64_t{placed.row} - kReach;
        width_ = placed.chart.mask.width + 2 * kReach;
        height_ = placed.chart.mask.height + 2 * kReach;
        std::vector<uint8_t> open(static_cast<size_t>(width_ * height_));
        for (int64_t y = 0; y < height_; ++y) {
            for (int64_t x = 0; x < width_; ++x) {
                const bool rim = x == 0 || y == 0 || x == width_ - 1 || y == height_ - 1;
                open[static_cast<size_t>(y * width_ + x)] = !rim && shares.open_to(chart, column_ + x, row_ + y);
            }
        }
        const std::vector<double> inside = distances(open, 0), outside = distances(open, 1);
        distance_.resize(open.size());
        for (size_t i = 0; i < open.size(); ++i) distance_[i] = open[i] ? inside[i] : 1 - outside[i];
    }

    // Interpolates bilinearly. All values are in samples of the image.
    double distance(const Vec2& p, Vec2& gradient) const {
        const double x = std::clamp(p.x() - static_cast<double>(column_), 0.0, static_cast<double>(width_) - 1.001);
        const double y = std::clamp(p.y() - static_cast<double>(row_), 0.0, static_cast<double>(height_) - 1.001);
        const auto column = static_cast<int64_t>(x), row = static_cast<int64_t>(y);
        const double u = x - static_cast<double>(column), v = y - static_cast<double>(row);
        const auto at = [&](int64_t i, int64_t j) {
            return distance_[static_cast<size_t>((row + j) * width_ + column + i)];
        };
        gradient = Vec2((1 - v) * (at(1, 0) - at(0, 0)) + v * (at(1, 1) - at(0, 1)),
                        (1 - u) * (at(0, 1) - at(0, 0)) + u * (at(1, 1) - at(1, 0)));
        return (1 - v) * ((1 - u) * at(0, 0) + u * at(1, 0)) + v * ((1 - u) * at(0, 1) + u * at(1, 1));
    }

  private:
    // Computes the Euclidean distance to the nearest sample of a kind: along rows first, then over the columns.
    std::vector<double> distances(const std::vector<uint8_t>& open, uint8_t kind) const {
        const auto far = static_cast<double>(width_ + height_);
        std::vector<double> across(open.size(), far), result(open.size());
        for (int64_t y = 0; y < height_; ++y) {
            const auto sweep = [&](int64_t first, int64_t step) {
                double d = far;
                for (int64_t x = first; x >= 0 && x < width_; x += step) {
                    const auto i = static_cast<size_t>(y * width_ + x);
                    d = open[i] == kind ? 0 : d + 1;
                    across[i] = std::min(across[i], d);
                }
            };
            sweep(0, 1);
            sweep(width_ - 1, -1);
        }
        for (int64_t x = 0; x < width_; ++x) {
            for (int64_t y = 0; y < height_; ++y) {
                double best = far * far;
                for (int64_t k = 0; k < height_; ++k) {
                    const double a = across[static_cast<size_t>(k * width_ + x)], b = static_cast<double>(k - y);
                    best = std::min(best, a * a + b * b);
                }
                result[static_cast<size_t>(y * width_ + x)] = std::sqrt(best);
            }
        }
        return result;
    }

    int64_t column_ = 0, row_ = 0, width_ = 0, height_ = 0;
    std::vector<double> distance_;
};

// Pushes the border back from samples that the chart must not define.
class Wall : public BorderForce {
  public:
    Wall(const Chart& chart, const std::vector<Vec2>& uv, const ChartPose& pose, const Territory& territory,
         double pressure)
        : pose_(pose), territory_(territory) {
        turn_ << std::cos(pose.angle), -std::sin(pose.angle), std::sin(pose.angle), std::cos(pose.angle);
        constexpr double kSpacing = 0.5;  // in samples, between points that are looked at
        for (size_t k = 0; k < chart.loop.size(); ++k) {
            const uint32_t v = chart.loop[k], w = chart.loop[(k + 1) % chart.loop.size()];
            const double length = (uv[w] - uv[v]).norm();
            const int parts = std::max(1, static_cast<int>(std::ceil(length * pose.scale / kSpacing)));
            for (int i = 0; i < parts; ++i)
                points_.push_back({v, w, static_cast<double>(i) / parts, stiffness(pressure) * length / parts});
        }
    }

    double energy(const std::vector<Vec2>& uv) const override {
        double sum = 0;
        for_each_close(
            uv, [&](const Point& point, double depth, const Vec2&) { sum += 0.5 * point.weight * depth * depth; });
        return sum;
    }
    void derivatives(const std::vector<Vec2>& uv, const Add& add) const override {
        for_each_close(uv, [&](const Point& point, double depth, const Vec2& inwards) {
            const Vec2 gradient = -point.weight * depth * inwards;
            const Eigen::Matrix2d block = point.weight * inwards * inwards.transpose();
            add(point.v, (1 - point.t) * gradient, (1 - point.t) * block);
            add(point.w, point.t * gradient, point.t * block);
        });
    }

  private:
    struct Point {
        uint32_t v, w;
        double t, weight;
    };

    // A map at its own size has a pressure of about 1, in energy per area. It presses kGive samples into the wall.
    double stiffness(double pressure) const {
        constexpr double kGive = 0.08;
        return pressure * pose_.scale / kGive;
    }
    // Calls body(point, depth, direction). Depth and direction are in object units.
    template <class Body>
    void for_each_close(const std::vector<Vec2>& uv, const Body& body) const {
        constexpr double kKept = 0.65;  // in samples: half a sample of band, and what the wall gives
        for (const Point& point : points_) {
            Vec2 gradient;
            const Vec2 p = pose_((1 - point.t) * uv[point.v] + point.t * uv[point.w]);
            const double distance = territory_.distance(p, gradient);
            if (distance < kKept) body(point, (kKept - distance) / pose_.scale, turn_.transpose() * gradient);
        }
    }

    const ChartPose& pose_;
    const Territory& territory_;
    Eigen::Matrix2d turn_;
    std::vector<Point> points_;
};

bool upright(const Mesh& mesh, const std::vector<Vec2>& uv) {
    return std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                       [&](const Triangle& t) { return twice_signed_area(uv[t[0]], uv[t[1]], uv[t[2]]) > 0; });
}

bool near_mask(const SampleMask& mask, const Vec2& p) {
    constexpr double kNear = 1.2;
    const auto column = static_cast<int64_t>(std::floor(p.x())), row = static_cast<int64_t>(std::floor(p.y()));
    for (int64_t y = row - 1; y <= row + 2; ++y) {
        for (int64_t x = column - 1; x <= column + 2; ++x) {
            const Vec2 sample(static_cast<double>(x), static_cast<double>(y));
            if (mask.at(x, y) && (p - sample).squaredNorm() <= kNear * kNear) return true;
        }
    }
    return false;
}

// Rasterises a map in place of the chart. If it makes no good disk in its share, returns false and leaves the chart.
bool place(const Chart& chart, uint32_t c, const std::vector<Vec2>& uv, const Shares& shares, PlacedChart& placed) {
    if (!upright(chart.mesh, uv)) return false;
    const std::vector<Vec2> border = border_of(chart, uv);
    if (find_crossing(border)) return false;
    ChartMask found = rasterize_chart_on_lattice(border, placed.chart.pose);
    if (!found.is_disk) return false;
    // Returns where the mask's first sample lies in the image.
    const auto corner = [&] {
        const Vec2 first = placed.chart.pose.offset - found.pose.offset;
        return std::array{std::llround(first.x()), std::llround(first.y())};
    };
    // The border may reach a little too far, and dilation ignores walls. Remove samples outside if that does no harm.
    std::vector<uint32_t> outside;
    SampleMask& mask = found.mask;
    for (uint32_t i = 0; i < mask.defined.size(); ++i) {
        if (mask.defined[i] && !shares.open_to(c, corner()[0] + i % mask.width, corner()[1] + i / mask.width))
            outside.push_back(i);
    }
    for (bool any = true; any && !outside.empty();) {
        std::vector<uint32_t> left;
        for (const uint32_t i : outside) {
            if (can_remove(mask, i)) {
                mask.defined[i] = 0;
            } else {
                left.push_back(i);
            }
        }
        any = left.size() < outside.size();
        outside = std::move(left);
    }
    if (!outside.empty()) return false;
    trim(found);
    if (!found.is_disk || found.border_length < std::max<size_t>(4, 2 * chart.paths.size())) return false;
    // Seams are closed at the mask's border, so the map's border must be near it everywhere.
    for (const Vec2& p : border) {
        if (!near_mask(found.mask, found.pose(p))) return false;
    }
    const auto [column, row] = corner();
    found.pose = placed.chart.pose;
    placed = {std::move(found), static_cast<uint32_t>(column), static_cast<uint32_t>(row)};
    return true;
}

void inflate_chart(const Chart& chart, uint32_t c, const std::vector<double>& importance, const InflateOptions& options,
                   const Shares& shares, ChartMap& map, PlacedChart& placed) {
    const Territory territory(shares, c, placed);
    const Wall wall(chart, map.uv, placed.chart.pose, territory, 1 / options.area_weight);
    ChartParametrizeOptions newton;
    newton.most_steps = options.most_steps;
    newton.tolerance = 1e-3;
    ChartMap grown = relax_chart(chart, importance, map, options.area_weight, wall, newton);
    const std::vector<Vec2> far = grown.uv;
    for (const double part : {1.0, 0.85, 0.7, 0.5, 0.3, 0.15}) {
        for (size_t v = 0; v < far.size(); ++v) grown.uv[v] = (1 - part) * map.uv[v] + part * far[v];
        if (!place(chart, c, grown.uv, shares, placed)) continue;
        measure_map(chart, importance, grown);
        map = std::move(grown);
        return;
    }
}

}  // namespace

void inflate(const std::vector<Chart>& charts, const std::vector<double>& importance, const InflateOptions& options,
             std::vector<ChartMap>& maps, Packing& packing) {
    for (int round = 0; round < options.rounds; ++round) {
        const Shares shares(packing);
        parallel_blocks(charts.size(), 1, options.threads, [&](size_t c, size_t, size_t) {
            inflate_chart(charts[c], static_cast<uint32_t>(c), charts[c].of_own_faces(importance), options, shares,
                          maps[c], packing.charts[c]);
        });
    }
    packing.defined = 0;
    for (const PlacedChart& placed : packing.charts) packing.defined += placed.chart.defined;
}

}  // namespace gim

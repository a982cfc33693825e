#include "encoder/charts/zipper.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "encoder/base/result.h"
#include "encoder/charts/repair_zipper.h"

namespace gim {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Cost of a point's first further sample, in squared mean spacings. The second costs three times as much, the third
// five times, and so on.
constexpr double kSingleStep = 0.5;
// Least distance between unified points along a path, in mean spacings.
constexpr double kLeastSpacing = 0.3;

// A cut-path as a curve, with its arc length from the begin node along the surface.
struct Curve {
    std::vector<Vec2> map;  // in samples of the image
    std::vector<Vec3> surface;
    std::vector<double> along;  // 0 .. length

    double length() const { return along.back(); }
};

Curve curve_of(const Chart& chart, const ChartMap& map, const ChartPose& pose, size_t path) {
    Curve curve;
    for (uint32_t i = chart.paths[path].first; i <= chart.path_end(path); ++i) {
        const uint32_t v = chart.loop[i % chart.loop.size()];
        curve.map.push_back(pose(map.uv[v]));
        curve.surface.push_back(chart.mesh.positions[v]);
        curve.along.push_back(curve.along.empty()
                                  ? 0
                                  : curve.along.back() +
                                        (curve.surface.back() - curve.surface[curve.surface.size() - 2]).norm());
    }
    return curve;
}

// Finds the point of the curve closest to p in the map. Returns where it lies, as a part of the curve's length.
double project(const Curve& curve, const Vec2& p) {
    double nearest = kInfinity, at = 0;
    for (size_t k = 0; k + 1 < curve.map.size(); ++k) {
        const Vec2 edge = curve.map[k + 1] - curve.map[k];
        const double length2 = edge.squaredNorm();
        const double t = length2 > 0 ? std::clamp((p - curve.map[k]).dot(edge) / length2, 0.0, 1.0) : 0;
        const double distance = (p - curve.map[k] - t * edge).squaredNorm();
        if (distance >= nearest) continue;
        nearest = distance;
        at = curve.along[k] + t * (curve.along[k + 1] - curve.along[k]);
    }
    return curve.length() > 0 ? at / curve.length() : 0;
}

Vec3 point_at(const Curve& curve, double part) {
    const double target = std::clamp(part, 0.0, 1.0) * curve.length();
    const auto after = std::upper_bound(curve.along.begin() + 1, curve.along.end() - 1, target);
    const auto k = static_cast<size_t>(after - curve.along.begin());
    const double step = curve.along[k] - curve.along[k - 1];
    const double t = step > 0 ? std::clamp((target - curve.along[k - 1]) / step, 0.0, 1.0) : 0;
    return (1 - t) * curve.surface[k - 1] + t * curve.surface[k];
}

// ---- cut-nodes ----------------------------------------------------------------------------------------------------

// Finds a sample for each node and returns its index in the loop. Samples keep the order of the nodes, lie at least
// `gap` apart, and have the least sum of squared distances. Indices count on past the loop's end: all lie within one
// turn after the first. Empty if the loop is too short.
std::vector<uint32_t> place_nodes(const std::vector<Vec2>& nodes, const std::vector<Vec2>& loop, uint32_t gap) {
    const auto count = static_cast<uint32_t>(nodes.size()), length = static_cast<uint32_t>(loop.size());
    if (uint64_t{count} * gap > length) return {};
    // The first node goes to one of the samples nearest to it. The others follow by dynamic programming.
    std::vector<uint32_t> starts(length);
    for (uint32_t i = 0; i < length; ++i) starts[i] = i;
    std::stable_sort(starts.begin(), starts.end(), [&](uint32_t a, uint32_t b) {
        return (loop[a] - nodes[0]).squaredNorm() < (loop[b] - nodes[0]).squaredNorm();
    });
    constexpr size_t kMostStarts = 8;
    starts.resize(std::min<size_t>(starts.size(), kMostStarts));
    double least = kInfinity;
    std::vector<uint32_t> best;
    std::vector<std::vector<uint32_t>> choice(count, std::vector<uint32_t>(length, kNone));
    for (const uint32_t start : starts) {
        // cost[j]: of the nodes so far if the last is at offset j or before. choice: the offset at which it then is.
        std::vector<double> cost(length, (loop[start] - nodes[0]).squaredNorm()), next_cost(length);
        std::fill(choice[0].begin(), choice[0].end(), 0);
        for (uint32_t k = 1; k < count; ++k) {
            double running = kInfinity;
            uint32_t at = kNone;
            for (uint32_t j = 0; j < length; ++j) {
                const bool room = j >= k * gap && j + (count - k) * gap <= length;
                if (room && std::isfinite(cost[j - gap])) {
                    const double here = cost[j - gap] + (loop[(start + j) % length] - nodes[k]).squaredNorm();
                    if (here < running) running = here, at = j;
                }
                next_cost[j] = running;
                choice[k][j] = at;
            }
            cost.swap(next_cost);
        }
        if (!(cost[length - 1] < least)) continue;
        least = cost[length - 1];
        best.assign(count, 0);
        uint32_t j = length - 1;
        for (uint32_t k = count; k-- > 1;) {
            best[k] = start + choice[k][j];
            j = choice[k][j] - gap;
        }
        best[0] = start;
    }
    return best;
}

// ---- zipper -------------------------------------------------------------------------------------------------------

// Finds the lock-step traversal that moves samples least. Empty if there is none. t and u: where the samples of the two
// sides lie along the curve, from begin node to end node, both included; u runs in the first side's direction. A point
// takes one sample of each side, and then up to `most_extra` more of one side.
std::vector<ZipStep> best_zipper(const std::vector<double>& t, const std::vector<double>& u, size_t most_extra) {
    const size_t rows = t.size(), columns = u.size();
    const double spacing = 1.0 / static_cast<double>(std::max(rows, columns) - 1);
    const double single = kSingleStep * spacing * spacing;
    struct Cell {
        double cost = kInfinity;
        int32_t extra = 0;  // further samples of the last point: of the first side if positive, else of the second
    };
    std::vector<Cell> cells(rows * columns);
    const auto apart = [&](size_t i, size_t j) { return (t[i] - u[j]) * (t[i] - u[j]); };
    // Tries all ways in which a point may go on. (i, j): the point's first samples. cost: of the cell before it.
    const auto extend = [&](double cost, size_t i, size_t j) {
        cost += apart(i, j);
        const auto offer = [&](size_t x, size_t y, double total, int32_t extra) {
            Cell& cell = cells[x * columns + y];
            if (total < cell.cost) cell = {total, extra};
        };
        offer(i, j, cost, 0);
        double sum = cost;
        for (size_t r = 1; r <= most_extra && i + r < rows; ++r) {
            sum += apart(i + r, j) + single * static_cast<double>(2 * r - 1);
            offer(i + r, j, sum, static_cast<int32_t>(r));
        }
        sum = cost;
        for (size_t r = 1; r <= most_extra && j + r < columns; ++r) {
            sum += apart(i, j + r) + single * static_cast<double>(2 * r - 1);
            offer(i, j + r, sum, -static_cast<int32_t>(r));
        }
    };
    extend(0, 0, 0);
    for (size_t i = 0; i + 1 < rows; ++i) {
        for (size_t j = 0; j + 1 < columns; ++j) {
            const double cost = cells[i * columns + j].cost;
            if (std::isfinite(cost)) extend(cost, i + 1, j + 1);
        }
    }
    std::vector<ZipStep> steps;
    if (!std::isfinite(cells.back().cost)) return steps;
    for (size_t i = rows - 1, j = columns - 1;;) {
        const int32_t extra = cells[i * columns + j].extra;
        const auto count = static_cast<size_t>(std::abs(extra));
        steps.insert(steps.end(), count, extra > 0 ? ZipStep::kFirst : ZipStep::kSecond);
        (extra > 0 ? i : j) -= count;
        if (i == 0 && j == 0) break;
        steps.push_back(ZipStep::kBoth);
        --i, --j;
    }
    std::reverse(steps.begin(), steps.end());
    return steps;
}

// Makes values rise from 0 (first) to 1 (last) with a least step. Moves them as little as possible (least squares, pool
// adjacent violators).
void spread(std::vector<double>& values) {
    const size_t count = values.size();
    if (count < 3) return;
    const double least = kLeastSpacing / static_cast<double>(count - 1);
    struct Pool {
        double sum;
        size_t size;
        double mean() const { return sum / static_cast<double>(size); }
    };
    std::vector<Pool> pools;
    for (size_t k = 1; k + 1 < count; ++k) {
        pools.push_back({values[k] - least * static_cast<double>(k), 1});
        while (pools.size() > 1 && pools[pools.size() - 2].mean() >= pools.back().mean()) {
            const Pool last = pools.back();
            pools.pop_back();
            pools.back().sum += last.sum;
            pools.back().size += last.size;
        }
    }
    size_t k = 1;
    const double top = 1 - least * static_cast<double>(count - 1);
    for (const Pool& pool : pools) {
        const double base = std::clamp(pool.mean(), 0.0, top);
        for (size_t n = 0; n < pool.size; ++n, ++k) values[k] = base + least * static_cast<double>(k);
    }
}

class Zipper {
  public:
    Zipper(MultiChartImage image, const std::vector<Chart>& charts, const std::vector<ChartMap>& maps,
           const Packing& packing)
        : image_(std::move(image)), charts_(charts), maps_(maps), packing_(packing) {}

    Result<MultiChartImage> run() {
        owner_ = owners_of(packing_);
        constexpr int kMostRounds = 10;
        for (int round = 0;; ++round) {
            GIM_CHECK(find_loops());
            node_at_.assign(charts_.size(), {});
            for (uint32_t c = 0; c < charts_.size(); ++c) {
                GIM_CHECK(cut_loop(c));
            }
            number_paths();
            close_all();
            GIM_TRY(spikes, repair_zippers(image_, [&] { close_all(); }));
            if (spikes.empty()) return std::move(image_);
            if (round == kMostRounds) return charts_too_small(spikes.size());
            for (const uint32_t i : spikes) {
                image_.mask.defined[i] = 0;
                image_.positions[i] = Vec3::Zero();
            }
        }
    }

  private:
    void close_all() {
        for (uint32_t c = 0; c < charts_.size(); ++c) {
            for (uint32_t p = 0; p < charts_[c].paths.size(); ++p) close(c, p);
        }
    }

    // Finds out which border belongs to which chart.
    Result<void> find_loops() {
        loops_ = trace_borders(image_.mask);
        loop_of_chart_.assign(charts_.size(), kNone);
        for (uint32_t l = 0; l < loops_.size(); ++l) {
            const uint32_t c = owner_[loops_[l][0]];
            if (loop_of_chart_[c] != kNone)
                return Error{Stage::kSample, "chart " + std::to_string(c) + " is no disk as it was packed"};
            loop_of_chart_[c] = l;
        }
        if (loops_.size() != charts_.size()) return Error{Stage::kSample, "packed charts touch each other"};
        return {};
    }

    Vec2 place_of(uint32_t sample) const {
        const uint32_t row = sample / image_.width(), column = sample % image_.width();
        return {static_cast<double>(column), static_cast<double>(row)};
    }

    Result<void> cut_loop(uint32_t c) {
        const Chart& chart = charts_[c];
        const std::vector<uint32_t>& loop = loops_[loop_of_chart_[c]];
        std::vector<Vec2> nodes, samples;
        for (const ChartPath& path : chart.paths)
            nodes.push_back(packing_.charts[c].chart.pose(maps_[c].uv[chart.loop[path.first]]));
        for (const uint32_t i : loop) samples.push_back(place_of(i));
        std::vector<uint32_t> at = place_nodes(nodes, samples, 2);
        if (at.empty()) at = place_nodes(nodes, samples, 1);
        if (at.empty())
            return Error{Stage::kSample, "chart " + std::to_string(c) + " has " + std::to_string(nodes.size()) +
                                             " corners on a border of " + std::to_string(loop.size()) +
                                             " samples; ask for more samples or fewer charts"};
        node_at_[c] = std::move(at);
        return {};
    }

    // Returns the samples of a path, both nodes included.
    std::vector<uint32_t> samples_of(uint32_t c, uint32_t p) const {
        const std::vector<uint32_t>& loop = loops_[loop_of_chart_[c]];
        const std::vector<uint32_t>& at = node_at_[c];
        const auto length = static_cast<uint32_t>(loop.size());
        const uint32_t begin = at[p], end = p + 1 < at.size() ? at[p + 1] : at[0] + length;
        std::vector<uint32_t> samples;
        for (uint32_t i = begin; i <= end; ++i) samples.push_back(loop[i % length]);
        return samples;
    }

    void number_paths() {
        image_.seams = {};
        first_path_.assign(charts_.size(), 0);
        uint32_t count = 0;
        for (uint32_t c = 0; c < charts_.size(); ++c) {
            first_path_[c] = count;
            count += static_cast<uint32_t>(charts_[c].paths.size());
        }
        for (uint32_t c = 0; c < charts_.size(); ++c) {
            image_.seams.loops.push_back({samples_of(c, 0).front(), static_cast<uint32_t>(charts_[c].paths.size())});
            for (uint32_t p = 0; p < charts_[c].paths.size(); ++p) {
                const ChartPath& path = charts_[c].paths[p];
                const uint32_t mate =
                    path.mate_chart == kNoMate ? kNoMate : first_path_[path.mate_chart] + path.mate_path;
                image_.seams.paths.push_back({mate, static_cast<uint32_t>(samples_of(c, p).size() - 1)});
            }
        }
        zipper_of_path_.assign(count, kNone);
        for (uint32_t k = 0; k < count; ++k) {
            if (image_.seams.paths[k].mate == kNoMate || image_.seams.paths[k].mate < k) continue;
            zipper_of_path_[k] = static_cast<uint32_t>(image_.seams.zippers.size());
            image_.seams.zippers.emplace_back();
        }
    }

    // Returns where samples lie along a curve (0..1). The nodes lie at its ends.
    std::vector<double> parts_of(const std::vector<uint32_t>& samples, const Curve& curve) const {
        std::vector<double> parts;
        for (const uint32_t i : samples) parts.push_back(project(curve, place_of(i)));
        parts.front() = 0;
        parts.back() = 1;
        return parts;
    }

    void close(uint32_t c, uint32_t p) {
        const ChartPath& path = charts_[c].paths[p];
        const uint32_t number = first_path_[c] + p;
        const Curve curve = curve_of(charts_[c], maps_[c], packing_.charts[c].chart.pose, p);
        const std::vector<uint32_t> own = samples_of(c, p);
        std::vector<double> t = parts_of(own, curve);
        if (path.mate_chart == kNoMate) {
            spread(t);
            for (size_t i = 0; i < own.size(); ++i) image_.positions[own[i]] = point_at(curve, t[i]);
            return;
        }
        if (image_.seams.paths[number].mate < number) return;  // done from the other side
        const uint32_t mate_chart = path.mate_chart;
        const Curve mate_curve =
            curve_of(charts_[mate_chart], maps_[mate_chart], packing_.charts[mate_chart].chart.pose, path.mate_path);
        std::vector<uint32_t> other = samples_of(mate_chart, path.mate_path);
        std::vector<double> u = parts_of(other, mate_curve);
        std::reverse(other.begin(), other.end());
        std::reverse(u.begin(), u.end());
        for (double& x : u) x = 1 - x;
        std::vector<ZipStep>& steps = image_.seams.zippers[zipper_of_path_[number]];
        // Long runs of samples in one point make folds. They cannot be avoided if one side is many times longer.
        for (size_t most_extra = 5; steps.empty(); most_extra *= 4) steps = best_zipper(t, u, most_extra);
        // Unified points along the path: their mean positions, and the samples they hold.
        std::vector<double> parts{0};
        std::vector<double> weight{2};
        std::vector<std::vector<uint32_t>> members{{own[0], other[0]}};
        size_t i = 0, j = 0;
        for (const ZipStep step : steps) {
            if (step == ZipStep::kBoth) parts.push_back(0), weight.push_back(0), members.emplace_back();
            if (step != ZipStep::kSecond)
                ++i, parts.back() += t[i], weight.back() += 1, members.back().push_back(own[i]);
            if (step != ZipStep::kFirst)
                ++j, parts.back() += u[j], weight.back() += 1, members.back().push_back(other[j]);
        }
        for (size_t k = 0; k < parts.size(); ++k) parts[k] /= weight[k];
        parts.front() = 0;
        parts.back() = 1;
        spread(parts);
        for (size_t k = 0; k < parts.size(); ++k) {
            const Vec3 point = point_at(curve, parts[k]);
            for (const uint32_t sample : members[k]) image_.positions[sample] = point;
        }
    }

    MultiChartImage image_;
    const std::vector<Chart>& charts_;
    const std::vector<ChartMap>& maps_;
    const Packing& packing_;
    std::vector<std::vector<uint32_t>> loops_, node_at_;
    std::vector<uint32_t> owner_, loop_of_chart_, first_path_, zipper_of_path_;
};

}  // namespace

Result<MultiChartImage> zip(MultiChartImage image, const std::vector<Chart>& charts, const std::vector<ChartMap>& maps,
                            const Packing& packing) {
    return Zipper(std::move(image), charts, maps, packing).run();
}

}  // namespace gim

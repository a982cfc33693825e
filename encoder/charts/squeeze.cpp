#include "encoder/charts/squeeze.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "encoder/surface/surface_samples.h"

namespace gim {

namespace {

constexpr int32_t kUnit = 64;  // weight of two charts that were never in each other's way
// How weights change from round to round.
constexpr double kForgiving = 0.9, kLeastGrowth = 1.2, kFurtherGrowth = 0.8;
// A move looks everywhere in kTurns orientations, and looks closely at kTried of the places it finds.
constexpr uint32_t kTurns = 6;
constexpr size_t kTried = 8;
constexpr double kMostWeighed = 1 << 29;  // sums over a rectangle stay within 31 bits

class Random {
  public:
    explicit Random(uint64_t seed) : state_(mix_bits(seed)) {}
    uint32_t operator()(uint32_t count) {
        state_ = mix_bits(state_);
        return static_cast<uint32_t>((state_ >> 32) % count);
    }

  private:
    uint64_t state_;
};

// Counts the samples of `a` that are in reach of `b`.
uint32_t count_overlap(const Piece& a, const PieceSpot& at, const Piece& b, const PieceSpot& bt) {
    const int64_t dx = int64_t{bt.column} - 1 - at.column, dy = int64_t{bt.row} - 1 - at.row;
    if (dx >= a.width || dy >= a.height || dx + b.width + 2 <= 0 || dy + b.height + 2 <= 0) return 0;
    uint32_t count = 0;
    size_t i = 0, j = 0;
    while (i < a.runs.size() && j < b.reach.size()) {
        const int64_t row = b.reach[j].row + dy;
        if (a.runs[i].row < row) {
            ++i;
        } else if (a.runs[i].row > row) {
            ++j;
        } else {
            const int64_t begin = a.runs[i].column, end = begin + a.runs[i].length;
            const int64_t other = b.reach[j].column + dx, other_end = other + b.reach[j].length;
            count += static_cast<uint32_t>(std::max<int64_t>(0, std::min(end, other_end) - std::max(begin, other)));
            ++(end < other_end ? i : j);
        }
    }
    return count;
}

// What is in a chart's way: the weights of the other charts as running sums along rows, per sample and per coarse cell.
class Field {
  public:
    void reset(uint32_t width, uint32_t height) {
        width_ = width, height_ = height, stride_ = width + 1;
        sums_.assign(size_t{stride_} * height, 0);
    }
    void paint(const Piece& piece, const PieceSpot& spot, int32_t weight) {
        for (const PieceRun& run : piece.reach) {
            const int64_t row = int64_t{spot.row} + run.row - 1;
            if (row < 0 || row >= height_) continue;
            const int64_t begin = std::max<int64_t>(0, int64_t{spot.column} + run.column - 1);
            const int64_t end = std::min<int64_t>(width_, int64_t{spot.column} + run.column - 1 + run.length);
            if (begin >= end) continue;
            int32_t* sums = sums_.data() + row * stride_;
            sums[begin] += weight;
            sums[end] -= weight;
        }
    }
    // Turns differences into running sums, and makes the coarse sums from them.
    void sum_up(uint32_t cell) {
        cell_ = cell;
        coarse_width_ = (width_ + cell - 1) / cell, coarse_height_ = (height_ + cell - 1) / cell;
        coarse_stride_ = 2 * coarse_width_ + 1;
        coarse_.assign(size_t{coarse_stride_} * coarse_height_, 0);
        for (uint32_t row = 0; row < height_; ++row) {
            int32_t* sums = sums_.data() + size_t{row} * stride_;
            int32_t value = 0, sum = 0;
            for (uint32_t column = 0; column <= width_; ++column) {
                value += sums[column];
                sums[column] = sum;
                sum += value;
            }
            int32_t* coarse = coarse_.data() + size_t{row / cell} * coarse_stride_;
            for (uint32_t k = 0; k < coarse_width_; ++k) coarse[k] += sums[k * cell];
            for (uint32_t k = coarse_width_; k < coarse_stride_; ++k) coarse[k] += sums[width_];
        }
    }
    int64_t cost(const Piece& piece, uint32_t column, uint32_t row) const {
        int64_t cost = 0;
        const int32_t* origin = sums_.data() + size_t{row} * stride_ + column;
        for (const PieceRun& run : piece.runs) {
            const int32_t* sums = origin + size_t{run.row} * stride_ + run.column;
            cost += sums[run.length] - sums[0];
        }
        return cost;
    }
    // Finds the costs of places (k * cell, row) for k = 0 .. count - 1, on coarse cells.
    void coarse_costs(const Piece& piece, uint32_t row, uint32_t count, int32_t* costs) const {
        std::fill_n(costs, count, 0);
        for (const PieceRun& run : piece.coarse) {
            if (row / cell_ + run.row >= coarse_height_) continue;
            const int32_t* begin = coarse_.data() + size_t{row / cell_ + run.row} * coarse_stride_ + run.column;
            const int32_t* end = begin + run.length;
            for (uint32_t k = 0; k < count; ++k) costs[k] += end[k] - begin[k];
        }
    }
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    uint32_t cell() const { return cell_; }

  private:
    uint32_t width_ = 0, height_ = 0, stride_ = 0, cell_ = 1, coarse_width_ = 0, coarse_height_ = 0, coarse_stride_ = 0;
    std::vector<int32_t> sums_, coarse_;
};

struct Place {
    int64_t cost = std::numeric_limits<int64_t>::max();
    PieceSpot spot;
};

bool fits(const Piece& piece, uint32_t width, uint32_t height) {
    return piece.width <= width && piece.height <= height;
}

// The best places of one orientation on coarse cells.
constexpr size_t kPlacesPerOrientation = 3;
using Places = std::array<Place, kPlacesPerOrientation>;

Places coarse_places(const Field& field, const Piece& piece, uint32_t orientation) {
    Places best;
    if (!fits(piece, field.width(), field.height())) return best;
    const uint32_t cell = field.cell(), count = (field.width() - piece.width) / cell + 1;
    std::vector<int32_t> costs(count);
    for (uint32_t row = 0; row + piece.height <= field.height(); row += cell) {
        field.coarse_costs(piece, row, count, costs.data());
        const auto least = static_cast<uint32_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
        Place place{costs[least], {orientation, least * cell, row}};
        for (Place& other : best) {
            if (place.cost < other.cost) std::swap(place, other);
        }
    }
    return best;
}

// Goes downhill from a place, in steps from half a cell down to a sample.
Place descend(const Field& field, const Piece& piece, Place place) {
    if (!fits(piece, field.width(), field.height())) return {};
    const int64_t last_column = int64_t{field.width()} - piece.width, last_row = int64_t{field.height()} - piece.height;
    place.cost = field.cost(piece, place.spot.column, place.spot.row);
    for (int64_t step = std::max<uint32_t>(1, field.cell() / 2); step > 0; step /= 2) {
        for (bool better = true; better && place.cost > 0;) {
            better = false;
            const PieceSpot from = place.spot;
            for (int64_t dy = -step; dy <= step; dy += step) {
                for (int64_t dx = -step; dx <= step; dx += step) {
                    const int64_t column = from.column + dx, row = from.row + dy;
                    if (column < 0 || row < 0 || column > last_column || row > last_row || (dx == 0 && dy == 0))
                        continue;
                    const int64_t cost = field.cost(piece, static_cast<uint32_t>(column), static_cast<uint32_t>(row));
                    if (cost >= place.cost) continue;
                    place = {cost, {from.orientation, static_cast<uint32_t>(column), static_cast<uint32_t>(row)}};
                    better = true;
                }
            }
        }
    }
    return place;
}

class Separator {
  public:
    Separator(const std::vector<Shape>& shapes, const SqueezeOptions& options)
        : shapes_(shapes), options_(options), random_(options.seed), count_(shapes.size()) {}

    // Returns whether `layout` could be freed of overlaps. Changes it in any case.
    bool run(PieceLayout& layout, uint64_t& moves) {
        weights_.assign(count_ * count_, kUnit);
        overlaps_.assign(count_ * count_, 0);
        for (size_t i = 0; i < count_; ++i) measure(layout, i);
        constexpr int kStrikes = 3, kPatience = 60;
        uint64_t least = std::numeric_limits<uint64_t>::max();
        PieceLayout best = layout;
        for (int strike = 0; strike < kStrikes; ++strike) {
            for (int patience = kPatience; patience > 0; --patience) {
                std::vector<uint32_t> order = overlapping();
                if (order.empty()) return true;
                shuffle(order);
                for (const uint32_t i : order) {
                    if (overlap_of(i) == 0) continue;
                    if (moves >= options_.most_moves) return false;
                    ++moves;
                    move(layout, i);
                }
                const uint64_t total = std::accumulate(overlaps_.begin(), overlaps_.end(), uint64_t{0});
                if (total == 0) return true;
                if (total < least) {
                    if (static_cast<double>(total) < 0.98 * static_cast<double>(least)) patience = kPatience;
                    least = total;
                    best = layout;
                }
                reweigh(layout.area());
            }
            layout = best;
            for (size_t i = 0; i < count_; ++i) measure(layout, i);
        }
        return false;
    }

    Random& random() { return random_; }

    // Takes a line of samples out of the rectangle. What lies beyond moves up. Returns false if a chart does not fit.
    bool shrink(PieceLayout& layout, bool column) {
        uint32_t& side = column ? layout.width : layout.height;
        if (side < 2) return false;
        const uint32_t line = random_(side);
        --side;
        for (size_t i = 0; i < count_; ++i) {
            const Piece* piece = &shapes_[i][layout.spots[i].orientation];
            uint32_t& at = column ? layout.spots[i].column : layout.spots[i].row;
            const uint32_t extent = column ? piece->width : piece->height;
            if (extent > side) {
                // The chart is too long for the rectangle. Take any orientation that fits.
                uint32_t o = 0;
                while (o < shapes_[i].size() && !fits(shapes_[i][o], layout.width, layout.height)) ++o;
                if (o == shapes_[i].size()) return false;
                layout.spots[i] = {o, 0, 0};
                continue;
            }
            if (at > 0 && at + extent / 2 > line) --at;
            at = std::min(at, side - extent);
        }
        return true;
    }

    // Swaps the places of two charts.
    void disturb(PieceLayout& layout) {
        if (count_ < 2) return;
        const uint32_t a = random_(static_cast<uint32_t>(count_));
        uint32_t b = random_(static_cast<uint32_t>(count_) - 1);
        b += b >= a;
        const auto put = [&](uint32_t i, const PieceSpot& centre, const Piece& former) {
            PieceSpot& spot = layout.spots[i];
            const Piece& piece = shapes_[i][spot.orientation];
            const auto along = [](uint32_t at, uint32_t old_extent, uint32_t extent, uint32_t side) {
                const int64_t from = int64_t{at} + old_extent / 2 - extent / 2;
                return static_cast<uint32_t>(std::clamp<int64_t>(from, 0, int64_t{side} - extent));
            };
            spot.column = along(centre.column, former.width, piece.width, layout.width);
            spot.row = along(centre.row, former.height, piece.height, layout.height);
        };
        const PieceSpot spot_a = layout.spots[a], spot_b = layout.spots[b];
        put(a, spot_b, shapes_[b][spot_b.orientation]);
        put(b, spot_a, shapes_[a][spot_a.orientation]);
    }

  private:
    const Piece& piece(const PieceLayout& layout, size_t i) const { return shapes_[i][layout.spots[i].orientation]; }

    void measure(const PieceLayout& layout, size_t i) {
        for (size_t j = 0; j < count_; ++j) {
            if (j == i) continue;
            overlaps_[i * count_ + j] = overlaps_[j * count_ + i] =
                count_overlap(piece(layout, i), layout.spots[i], piece(layout, j), layout.spots[j]);
        }
    }
    uint64_t overlap_of(size_t i) const {
        return std::accumulate(overlaps_.begin() + static_cast<std::ptrdiff_t>(i * count_),
                               overlaps_.begin() + static_cast<std::ptrdiff_t>((i + 1) * count_), uint64_t{0});
    }
    std::vector<uint32_t> overlapping() const {
        std::vector<uint32_t> result;
        for (uint32_t i = 0; i < count_; ++i) {
            if (overlap_of(i) > 0) result.push_back(i);
        }
        return result;
    }
    void shuffle(std::vector<uint32_t>& order) {
        for (size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random_(static_cast<uint32_t>(k))]);
    }
    // Raises the weights of pairs that overlap, the more they do. Slowly lowers the other weights.
    void reweigh(uint64_t area) {
        const auto most = std::max(2 * kUnit, static_cast<int32_t>(kMostWeighed / static_cast<double>(area)));
        const uint32_t largest = *std::max_element(overlaps_.begin(), overlaps_.end());
        for (size_t k = 0; k < weights_.size(); ++k) {
            double factor = kForgiving;
            if (overlaps_[k] > 0) factor = kLeastGrowth + kFurtherGrowth * overlaps_[k] / largest;
            weights_[k] = std::clamp(static_cast<int32_t>(weights_[k] * factor), kUnit, most);
        }
    }

    // Returns the spot of chart i in orientation o that keeps its centre. It lies inside the rectangle if possible.
    PieceSpot centred(const PieceLayout& layout, size_t i, uint32_t o) const {
        const Piece &from = piece(layout, i), &to = shapes_[i][o];
        const auto along = [](uint32_t at, uint32_t old_extent, uint32_t extent, uint32_t side) {
            const int64_t begin = int64_t{at} + (int64_t{old_extent} - extent) / 2;
            return static_cast<uint32_t>(std::clamp<int64_t>(begin, 0, std::max<int64_t>(0, int64_t{side} - extent)));
        };
        return {o, along(layout.spots[i].column, from.width, to.width, layout.width),
                along(layout.spots[i].row, from.height, to.height, layout.height)};
    }

    // Puts a chart where it overlaps the others least.
    void move(PieceLayout& layout, uint32_t i) {
        const Shape& shape = shapes_[i];
        field_.reset(layout.width, layout.height);
        for (size_t j = 0; j < count_; ++j) {
            if (j != i) field_.paint(piece(layout, j), layout.spots[j], weights_[i * count_ + j]);
        }
        field_.sum_up(shape[0].cell);
        // Look here and close by, in orientations close by.
        const auto count = static_cast<uint32_t>(shape.size());
        const uint32_t now = layout.spots[i].orientation;
        Place best = descend(field_, shape[now], {0, layout.spots[i]});
        for (const uint32_t o : {(now + 1) % count, (now + count - 1) % count}) {
            if (o == now || best.cost == 0) continue;
            const Place place = descend(field_, shape[o], {0, centred(layout, i, o)});
            if (place.cost < best.cost) best = place;
        }
        // Look everywhere in a few of all orientations.
        candidates_.clear();
        for (uint32_t k = 0; k < std::min(kTurns, count); ++k) {
            const uint32_t o = count <= kTurns ? k : random_(count);
            const Places places = coarse_places(field_, shape[o], o);
            candidates_.insert(candidates_.end(), places.begin(), places.end());
        }
        std::stable_sort(candidates_.begin(), candidates_.end(),
                         [](const Place& a, const Place& b) { return a.cost < b.cost; });
        for (size_t k = 0; k < std::min(kTried, candidates_.size()) && best.cost > 0; ++k) {
            if (candidates_[k].cost == std::numeric_limits<int64_t>::max()) break;
            const Place place = descend(field_, shape[candidates_[k].spot.orientation], candidates_[k]);
            if (place.cost < best.cost) best = place;
        }
        layout.spots[i] = best.spot;
        measure(layout, i);
    }

    const std::vector<Shape>& shapes_;
    const SqueezeOptions& options_;
    Random random_;
    size_t count_;
    std::vector<int32_t> weights_;
    std::vector<uint32_t> overlaps_;
    Field field_;
    std::vector<Place> candidates_;
};

}  // namespace

PieceLayout separate(const std::vector<Shape>& shapes, PieceLayout layout, const SqueezeOptions& options,
                     uint64_t& moves) {
    if (!Separator(shapes, options).run(layout, moves)) layout.spots.clear();
    return layout;
}

PieceLayout squeeze(const std::vector<Shape>& shapes, PieceLayout layout, const SqueezeOptions& options,
                    uint64_t& moves) {
    Separator separator(shapes, options);
    const double aspect = static_cast<double>(layout.width) / layout.height;
    uint32_t lines = 8;
    bool failed = false;
    // The rectangle keeps its shape until that fails. Then either side may shrink.
    const auto shrinks_width = [&](const PieceLayout& now) {
        const double limit = 0.9 * options.most_aspect, ratio = static_cast<double>(now.width) / now.height;
        if (ratio > limit || ratio < 1 / limit) return ratio > 1;
        return failed ? separator.random()(2) == 0 : ratio > aspect;
    };
    while (moves < options.most_moves && layout.area() > options.least_area) {
        PieceLayout next = layout;
        bool possible = true;
        for (uint32_t k = 0; k < lines && possible && next.area() > options.least_area; ++k)
            possible = separator.shrink(next, shrinks_width(next));
        if (failed && lines == 1 && separator.random()(2) == 0) separator.disturb(next);
        if (possible && separator.run(next, moves)) {
            layout = std::move(next);
            failed = false;
        } else {
            lines = std::max(1u, lines / 2);
            failed = true;
        }
    }
    return layout;
}

}  // namespace gim

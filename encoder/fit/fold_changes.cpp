#include "encoder/fit/fold_changes.h"

#include <algorithm>
#include <cmath>

namespace gim {

namespace {

// A bit lowers the squared distance, in squared steps, by the inverse of this at high rates (fit_coded.cpp).
constexpr double kBitsPerDistance = 8.7;
constexpr double kMostSlope = 2;  // of a detail's response at depth 1, between neighbours; generous

void insert(std::vector<DetailChange>& best, const DetailChange& change, size_t most) {
    const auto at = std::find_if(best.begin(), best.end(), [&](const DetailChange& c) { return change.cost < c.cost; });
    best.insert(at, change);
    if (best.size() > most) best.pop_back();
}

}  // namespace

FoldChanges::FoldChanges(const FoldState& state)
    : state_(state),
      reaches_(state.gluing()),
      x_(state.x()),
      followed_(state.moved().size()),
      off_at_(state.gluing().sample_count(), kNone) {}

void FoldChanges::follow_state() {
    for (; followed_ < state_.moved().size(); ++followed_) {
        const uint32_t v = state_.moved()[followed_];
        x_[v] = state_.x()[v];
    }
}

std::vector<DetailChange> FoldChanges::best_around(uint32_t cell, uint32_t from_depth, uint32_t to_depth, size_t most) {
    follow_state();
    CodedImage& image = state_.image();
    const std::vector<CellInPart> parts = image.parts_at(cell);
    std::vector<DetailChange> best;
    std::vector<PlaceInPart> tried;  // where parts share details
    for (const CellInPart& at : parts) {
        for (uint32_t depth = from_depth; depth <= std::min(to_depth, image.depths(at.part)); ++depth) {
            for_each_place_near(at, depth, [&](const PlaceInPart& place) {
                const PlaceInPart source = image.source_of(place);
                if (parts.size() > 1) {
                    if (std::find(tried.begin(), tried.end(), source) != tried.end()) return;
                    tried.push_back(source);
                }
                const double limit = best.size() == most ? best.back().cost : -kLeastFoldGain;
                if (const auto change = best_of_detail(source, limit)) insert(best, *change, most);
            });
        }
    }
    return best;
}

// Calls body(place) for the details around a cell, band by band.
template <class Body>
void FoldChanges::for_each_place_near(const CellInPart& at, uint32_t depth, const Body& body) {
    for (const auto orientation : {Orientation::kHorizontal, Orientation::kVertical, Orientation::kDiagonal}) {
        PlaceInPart place{at.part, depth, orientation, 0, 0};
        const Band band = state_.image().band(place);
        const double size = 1u << depth, reach = depth == 1 ? 1.3 : 1.0;
        const double middle_row = at.row / size - (orientation == Orientation::kHorizontal ? 0 : 0.5);
        const double middle_column = at.column / size - (orientation == Orientation::kVertical ? 0 : 0.5);
        const auto first = [&](double middle) {
            return static_cast<uint32_t>(std::max(0.0, std::ceil(middle - reach)));
        };
        const auto last = [&](double middle, uint32_t count) {
            return std::min(static_cast<int64_t>(std::floor(middle + reach)), int64_t{count} - 1);
        };
        for (place.row = first(middle_row); place.row <= last(middle_row, band.rows); ++place.row) {
            for (place.column = first(middle_column); place.column <= last(middle_column, band.columns); ++place.column)
                body(place);
        }
    }
}

const DetailReach& FoldChanges::reach_of(const PlaceInPart& place) {
    const DetailSteps steps = state_.image().steps_at(place.depth);
    const float step = steps.of(place.orientation) * std::max(1.0f, steps.tangential);
    // Neighbours move against each other by so much at most.
    const double most = kMostSlope * state_.unit() * double{step} / (1u << (place.depth - 1));
    return reaches_.find(state_.image().moved_by(place), state_.margin(), most);
}

double FoldChanges::fold_cost_before(const DetailReach& reach) const {
    double cost = 0;
    for (const uint32_t cell : reach.cells) cost += state_.cost(cell);
    return cost;
}

double FoldChanges::fold_cost_after(const DetailReach& reach, const Vec3& shift, double most) {
    for (const auto& [v, weight] : reach.corners) x_[v] += double{weight} * shift;
    double cost = 0;
    for (const uint32_t cell : reach.cells) {
        cost += state_.cost_at(x_, cell);
        if (cost > most) break;
    }
    for (const auto& [v, weight] : reach.corners) x_[v] = state_.x()[v];
    return cost;
}

FoldChanges::Off FoldChanges::off_now(uint32_t v) {
    const Vec3& before = state_.x_before()[v];
    if (off_at_[v] == kNone) {
        const FitReference& reference = state_.reference();
        const ClosestPoint at = reference.tree.find(before, state_.face_near(v));
        const Vec3& normal = reference.normals[at.triangle];
        off_at_[v] = static_cast<uint32_t>(offs_.size());
        offs_.push_back({normal, (before - at.point).dot(normal)});
    }
    Off off = offs_[off_at_[v]];
    off.distance += (state_.x()[v] - before).dot(off.normal);
    return off;
}

double FoldChanges::bits_per_distance() const { return kBitsPerDistance / (state_.step() * state_.step()); }

FoldChanges::DistanceCost FoldChanges::distance_cost(const DetailReach& reach) {
    DistanceCost cost;
    for (const auto& [v, weight] : reach.samples) {
        const Off off = off_now(v);
        const Vec3 normal = double{weight} * off.normal;
        cost.a.noalias() += normal * normal.transpose();
        cost.b += 2 * off.distance * normal;
    }
    cost.a *= bits_per_distance();
    cost.b *= bits_per_distance();
    return cost;
}

double FoldChanges::distance_cost_of(const std::vector<Vec3>& x, std::span<const uint32_t> samples) {
    double sum = 0;
    for (const uint32_t v : samples) {
        const Off off = off_now(v);
        const double by = (x[v] - state_.x()[v]).dot(off.normal);
        sum += by * (2 * off.distance + by);
    }
    return bits_per_distance() * sum;
}

// Returns the detail's best change if it costs less than `limit`.
std::optional<DetailChange> FoldChanges::best_of_detail(const PlaceInPart& p, double limit) {
    std::optional<DetailChange> best;
    const DetailReach& reach = reach_of(p);
    const double before = fold_cost_before(reach);
    if (before < kLeastFoldGain) return best;
    CodedImage& image = state_.image();
    const DetailSteps steps = image.steps_at(p.depth);
    const DetailFrame frame = image.frame(state_.levels(), p);
    float step[3];
    steps_in(frame, steps, p.orientation, step);
    const Band integers = image.band(p);
    std::optional<DistanceCost> distance;
    for (uint32_t k = 0; k < 3; ++k) {
        const int32_t now = integers.row(p.row)[3 * p.column + k];
        for (const int32_t by : {-1, 1}) {
            DetailChange change{p, k, by, Vec3::Zero(), 0};
            const double length = state_.unit() * double{dequantize(now + by, step[k]) - dequantize(now, step[k])};
            for (int i = 0; i < 3; ++i) change.shift[i] = length * double{frame.axis[k][i]};
            change.cost = state_.bits_of(p, k, by) - before;
            if (change.cost > limit) continue;
            if (!distance) distance = distance_cost(reach);
            change.cost += distance->of(change.shift);
            if (change.cost > limit) continue;
            change.cost += fold_cost_after(reach, change.shift, limit - change.cost);
            if (change.cost < limit) {
                limit = change.cost;
                best = change;
            }
        }
    }
    return best;
}

double FoldChanges::cost_of(const DetailChange& change) {
    follow_state();
    const DetailReach& reach = reach_of(change.place);
    const double bits = state_.bits_of(change.place, change.component, change.by);
    return bits - fold_cost_before(reach) + distance_cost(reach).of(change.shift) +
           fold_cost_after(reach, change.shift, HUGE_VAL);
}

}  // namespace gim

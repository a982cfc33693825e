#include "encoder/fit/fold_passes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "encoder/base/parallel.h"
#include "encoder/code/coefficient_prices.h"
#include "encoder/fit/detail_reach.h"
#include "encoder/fit/image_surface.h"

namespace gim {

namespace {

// Cosine below which a face counts as folded. At creases a good face may stand across the nearest one.
constexpr double kSteep = 0.03;
// A bit lowers the squared distance, in squared steps, by the inverse of this at high rates (fit_coded.cpp).
constexpr double kBitsPerDistance = 8.7;
constexpr double kLeastGain = 4;       // bits
constexpr double kMostSlope = 2;       // of a detail's response at depth 1, between neighbours; generous
constexpr uint32_t kDeepest = 3;       // depth of the coarsest details that are changed without decoding again
constexpr uint32_t kDeepestTried = 5;  // depth of the coarsest details that are tried
constexpr uint32_t kCluster = 3;       // reach of a cluster of folded cells
constexpr size_t kFewest = 2;          // folded cells of a cluster that is worth a coarser detail
constexpr size_t kTrials = 8;          // changes tried for a cluster
constexpr double kMostFolded = 0.03;   // part of the cells; where more seem folded, sheets lie on each other
constexpr double kStill = 1e-8;        // squared shift, in squared steps, of a sample that does not move
constexpr double kUnsuspicious = 0.7;  // cosine above which a stale reference face is good enough

struct Change {
    PlaceInPart place;
    uint32_t component = 0;
    int32_t by = 0;
    Vec3 shift = Vec3::Zero();  // of a sample of weight 1, in the frame
    double cost = 0;            // bits
};

// How much farther from the reference the samples get, in bits, if those of weight 1 shift by s: s b + s A s.
struct DistanceCost {
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Vec3 b = Vec3::Zero();

    double of(const Vec3& shift) const { return shift.dot(b + a * shift); }
};

}  // namespace

class FoldPass {
  public:
    FoldPass(FoldPasses& passes, CodedImage& image, const RepairEffort& effort)
        : r_(passes),
          image_(image),
          effort_(effort),
          unit_(double{image.units().step} * passes.frame_.scale),
          quantizer_(double{image.units().quantizer}),
          prices_(image.bands()),
          reaches_(passes.gluing_),
          levels_(image.decode()),
          x_(positions(levels_)),
          sample_off_(passes.gluing_.sample_count(), kNone),
          margin_(passes.gluing_.kind.size(), 0) {}

    // Changes fine details. Returns the number of changes.
    size_t run() {
        size_t changes = 0;
        const std::vector<uint32_t> cells = steep_cells();
        if (are_too_many(cells)) return 0;
        for (const uint32_t cell : cells) {
            if (r_.is_stuck_[cell] || cost_of_cell(cell) == 0) continue;
            const std::vector<Change> best = best_changes(cell, 1, kDeepest, 1);
            r_.is_stuck_[cell] = best.empty();
            if (best.empty()) continue;
            apply(best[0]);
            ++changes;
        }
        return changes;
    }

    // Tries coarser details where several neighbours are folded. Decodes for each trial, because the frames of finer
    // details turn with a coarser one. Returns the number of changes.
    size_t run_coarse() {
        const std::vector<uint32_t> cells = steep_cells();
        if (are_too_many(cells)) return 0;
        std::vector<uint8_t> is_done(r_.gluing_.kind.size(), 0), is_steep(is_done.size(), 0);
        for (const uint32_t cell : cells) is_steep[cell] = 1;
        size_t changes = 0;
        for (const uint32_t cell : cells) {
            if (is_done[cell] || cost_of_cell(cell) == 0) continue;
            size_t folded = 0;
            for_each_cell_near(cell, kCluster, [&](uint32_t other) { folded += is_steep[other]; });
            if (folded < kFewest) continue;
            for_each_cell_near(cell, 2 * kCluster, [&](uint32_t other) { is_done[other] = 1; });
            const std::vector<Change> best = best_changes(cell, kDeepest + 1, kDeepestTried, kTrials);
            changes += std::any_of(best.begin(), best.end(), [&](const Change& c) { return apply_if_it_pays(c); });
        }
        return changes;
    }

  private:
    std::vector<Vec3> positions(const CodedImage::Levels& levels) const {
        return positions_of(image_.samples(levels), image_.units(), r_.frame_);
    }

    bool are_too_many(const std::vector<uint32_t>& cells) const {
        return static_cast<double>(cells.size()) > kMostFolded * static_cast<double>(r_.gluing_.kind.size());
    }

    template <class Body>
    void for_each_cell_near(uint32_t cell, uint32_t reach, const Body& body) const {
        const uint32_t columns = r_.gluing_.width - 1, row = cell / columns, column = cell % columns;
        for (uint32_t r = row - std::min(row, reach); r <= std::min(row + reach, r_.gluing_.height - 2); ++r) {
            for (uint32_t c = column - std::min(column, reach); c <= std::min(column + reach, columns - 1); ++c)
                body(r * columns + c);
        }
    }

    Vec3 normal_of(const Triangle& t) const {
        const Vec3& a = x_[t[0]];
        return r_.front_ * direction_or((x_[t[1]] - a).cross(x_[t[2]] - a), Vec3::Zero());
    }

    double cosine(uint32_t slot, const Triangle& t) {
        uint32_t& face = r_.nearest_[slot];
        const Vec3 normal = normal_of(t);
        if (face != kNone) {
            const double stale = normal.dot(r_.reference_.normals[face]);
            if (stale > kUnsuspicious) return stale;
        }
        face = r_.reference_.tree.find((x_[t[0]] + x_[t[1]] + x_[t[2]]) / 3, face).triangle;
        return normal.dot(r_.reference_.normals[face]);
    }

    std::vector<uint32_t> steep_cells() {
        std::vector<uint8_t> is_steep(r_.gluing_.kind.size());
        parallel_blocks(is_steep.size(), 1024, 0, [&](size_t, size_t begin, size_t end) {
            for (size_t cell = begin; cell < end; ++cell) {
                const auto faces = split_cell(x_, r_.gluing_, static_cast<uint32_t>(cell));
                double least = 1;
                for (size_t half = 0; half < 2; ++half) {
                    if (faces[half] == kNoFace) continue;
                    const auto slot = static_cast<uint32_t>(2 * cell + half);
                    const double c = cosine(slot, faces[half]);
                    least = std::min(least, c);
                    if (c < kSteep) is_steep[cell] = 1;
                }
                margin_[cell] = margin_of(faces, least);
            }
        });
        std::vector<uint32_t> cells;
        for (uint32_t cell = 0; cell < is_steep.size(); ++cell) {
            if (is_steep[cell]) cells.push_back(cell);
        }
        return cells;
    }

    // Returns how far a corner of the cell may move against the others before a face can turn steep.
    double margin_of(const std::array<Triangle, 2>& faces, double least_cosine) const {
        if (least_cosine < kUnsuspicious) return 0;
        double margin = std::numeric_limits<double>::infinity();
        for (const Triangle& t : faces) {
            if (t == kNoFace) continue;
            const Vec3 a = x_[t[1]] - x_[t[0]], b = x_[t[2]] - x_[t[0]];
            const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
            if (longest > 0) margin = std::min(margin, a.cross(b).norm() / std::sqrt(longest));
        }
        return margin;
    }

    // Uses the reference faces that were nearest when the pass began.
    double cost_of_cell(uint32_t cell) const {
        const auto faces = split_cell(x_, r_.gluing_, cell);
        double cost = 0;
        for (size_t half = 0; half < 2; ++half) {
            if (faces[half] == kNoFace) continue;
            const uint32_t slot = 2 * cell + static_cast<uint32_t>(half);
            const uint32_t face = r_.nearest_[slot] != kNone ? r_.nearest_[slot] : r_.nearest_[slot ^ 1];
            if (face == kNone) continue;
            const double c = normal_of(faces[half]).dot(r_.reference_.normals[face]);
            if (c < kSteep) cost += effort_.fold + effort_.turn * (kSteep - c);
        }
        return cost;
    }

    struct Off {
        Vec3 normal = Vec3::Zero();
        double distance = 0;  // along the normal
    };
    const Off& off_of(uint32_t v) {
        if (sample_off_[v] == kNone) {
            const ClosestPoint at = r_.reference_.tree.find(x_[v], offs_.empty() ? kNone : last_face_);
            last_face_ = at.triangle;
            const Vec3& normal = r_.reference_.normals[at.triangle];
            sample_off_[v] = static_cast<uint32_t>(offs_.size());
            offs_.push_back({normal, (x_[v] - at.point).dot(normal)});
        }
        return offs_[sample_off_[v]];
    }

    // The reference counts as flat around a sample until the pass ends.
    void shift_off(uint32_t v, const Vec3& shift) {
        if (sample_off_[v] == kNone) return;
        Off& off = offs_[sample_off_[v]];
        off.distance += shift.dot(off.normal);
    }

    DistanceCost distance_cost(const DetailReach& reach) {
        const double step = unit_ * quantizer_, scale = kBitsPerDistance / (step * step);
        DistanceCost cost;
        for (const auto& [v, weight] : reach.samples) {
            const Off& off = off_of(v);
            const Vec3 normal = double{weight} * off.normal;
            cost.a.noalias() += normal * normal.transpose();
            cost.b += 2 * off.distance * normal;
        }
        cost.a *= scale;
        cost.b *= scale;
        return cost;
    }

    void move(const WeightedSamples& samples, const Vec3& shift) {
        for (const auto& [v, weight] : samples) x_[v] += double{weight} * shift;
    }

    const DetailReach& reach_of(const PlaceInPart& p) {
        // Neighbours move against each other by so much at most.
        const double most = kMostSlope * unit_ * double{tangential_step_at(p)} / (1u << (p.depth - 1));
        return reaches_.find(image_.moved_by(p), margin_, most);
    }

    float tangential_step_at(const PlaceInPart& p) const {
        const DetailSteps steps = image_.steps_at(p.depth);
        return steps.of(p.orientation) * std::max(1.0f, steps.tangential);
    }

    // Returns the best changes of details of these depths, best first. Each is the best of its detail.
    std::vector<Change> best_changes(uint32_t cell, uint32_t from_depth, uint32_t to_depth, size_t most) {
        const std::vector<CellInPart> parts = image_.parts_at(cell);
        std::vector<Change> best;
        std::vector<PlaceInPart> tried;  // where parts share details
        for (const CellInPart& at : parts) {
            for (uint32_t depth = from_depth; depth <= std::min(to_depth, image_.depths(at.part)); ++depth) {
                for_each_place_near(at, depth, [&](const PlaceInPart& place) {
                    const PlaceInPart source = image_.source_of(place);
                    if (parts.size() > 1) {
                        if (std::find(tried.begin(), tried.end(), source) != tried.end()) return;
                        tried.push_back(source);
                    }
                    const double limit = best.size() == most ? best.back().cost : -kLeastGain;
                    if (const auto change = best_of_detail(source, limit)) insert(best, *change, most);
                });
            }
        }
        return best;
    }

    // Calls body(place) for the details around a cell, band by band.
    template <class Body>
    void for_each_place_near(const CellInPart& at, uint32_t depth, const Body& body) {
        for (const auto orientation : {Orientation::kHorizontal, Orientation::kVertical, Orientation::kDiagonal}) {
            PlaceInPart place{at.part, depth, orientation, 0, 0};
            const Band band = image_.band(place);
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
                for (place.column = first(middle_column); place.column <= last(middle_column, band.columns);
                     ++place.column)
                    body(place);
            }
        }
    }

    static void insert(std::vector<Change>& best, const Change& change, size_t most) {
        const auto at = std::find_if(best.begin(), best.end(), [&](const Change& c) { return change.cost < c.cost; });
        best.insert(at, change);
        if (best.size() > most) best.pop_back();
    }

    // Returns the detail's best change if it costs less than `limit`.
    std::optional<Change> best_of_detail(const PlaceInPart& p, double limit) {
        std::optional<Change> best;
        const DetailReach& reach = reach_of(p);
        double before = 0;
        for (const uint32_t cell : reach.cells) before += cost_of_cell(cell);
        if (before < kLeastGain) return best;
        const DetailSteps steps = image_.steps_at(p.depth);
        const DetailFrame frame = image_.frame(levels_, p);
        float step[3];
        steps_in(frame, steps, p.orientation, step);
        const Band integers = image_.band(p);
        std::optional<DistanceCost> distance;
        for (uint32_t k = 0; k < 3; ++k) {
            const int32_t now = integers.row(p.row)[3 * p.column + k];
            for (const int32_t by : {-1, 1}) {
                Change change{p, k, by, Vec3::Zero(), 0};
                const double length = unit_ * double{dequantize(now + by, step[k]) - dequantize(now, step[k])};
                for (int i = 0; i < 3; ++i) change.shift[i] = length * double{frame.axis[k][i]};
                change.cost = prices_.bits_of_change(integers, p.row, p.column, k, by) - before;
                if (change.cost > limit) continue;
                if (!distance) distance = distance_cost(reach);
                change.cost += distance->of(change.shift);
                if (change.cost > limit) continue;
                move(reach.corners, change.shift);
                for (const uint32_t cell : reach.cells) change.cost += cost_of_cell(cell);
                move(reach.corners, -change.shift);
                if (change.cost < limit) {
                    limit = change.cost;
                    best = change;
                }
            }
        }
        return best;
    }

    // Makes the change and decodes again. Takes it back if it does not pay. Returns whether it stays.
    bool apply_if_it_pays(const Change& change) {
        const PlaceInPart& p = change.place;
        const Band band = image_.band(p);
        int32_t& integer = band.row(p.row)[3 * p.column + change.component];
        const double bits = prices_.bits_of_change(band, p.row, p.column, change.component, change.by);
        integer += change.by;
        CodedImage::Levels levels = image_.decode();
        std::vector<Vec3> x = positions(levels);
        std::vector<uint32_t> moved;
        const std::vector<uint32_t> nearest_before = r_.nearest_;
        if (bits + cost_of_move(x, moved) >= -kLeastGain) {
            integer -= change.by;
            r_.nearest_ = nearest_before;
            return false;
        }
        for (uint32_t v = 0; v < x.size(); ++v) shift_off(v, x[v] - x_[v]);
        levels_ = std::move(levels);
        x_ = std::move(x);
        for (const uint32_t cell : moved) r_.is_stuck_[cell] = 0;
        return true;
    }

    // What it costs, in distance and folds, to move the samples to x. Adds the cells that move.
    double cost_of_move(std::vector<Vec3>& x, std::vector<uint32_t>& cells) {
        const double step = unit_ * quantizer_;
        double sum = 0;
        std::vector<uint8_t> is_known(r_.gluing_.kind.size(), 0);
        for (uint32_t v = 0; v < x.size(); ++v) {
            const Vec3 shift = x[v] - x_[v];
            if (!(shift.squaredNorm() > kStill * step * step) || !r_.gluing_.is_defined(v)) continue;
            const Off& off = off_of(v);
            const double by = shift.dot(off.normal);
            sum += by * (2 * off.distance + by);
            for_each_cell_at(r_.gluing_, v, [&](uint32_t cell) {
                if (is_known[cell] || r_.gluing_.kind[cell] == CellKind::kEmpty) return;
                is_known[cell] = 1;
                cells.push_back(cell);
            });
        }
        double cost = kBitsPerDistance * sum / (step * step);
        for (const uint32_t cell : cells) cost -= cost_of_cell(cell);
        x_.swap(x);
        for (const uint32_t cell : cells) {
            const auto faces = split_cell(x_, r_.gluing_, cell);
            for (uint32_t half = 0; half < 2; ++half) {
                if (faces[half] != kNoFace) cosine(2 * cell + half, faces[half]);
            }
            cost += cost_of_cell(cell);
        }
        x_.swap(x);
        return cost;
    }

    void apply(const Change& change) {
        const PlaceInPart& p = change.place;
        image_.band(p).row(p.row)[3 * p.column + change.component] += change.by;
        const DetailReach& reach = reach_of(p);
        move(reach.samples, change.shift);
        for (const auto& [v, weight] : reach.samples) {
            shift_off(v, double{weight} * change.shift);
            for_each_cell_at(r_.gluing_, v, [&](uint32_t cell) { r_.is_stuck_[cell] = 0; });
        }
    }

    FoldPasses& r_;
    CodedImage& image_;
    RepairEffort effort_;
    double unit_;  // length of a unit in the frame
    double quantizer_;
    CoefficientPrices prices_;
    ReachFinder reaches_;
    CodedImage::Levels levels_;
    std::vector<Vec3> x_;
    std::vector<uint32_t> sample_off_;
    std::vector<Off> offs_;
    uint32_t last_face_ = kNone;
    std::vector<double> margin_;  // per cell
};

FoldPasses::FoldPasses(const GridGluing& gluing, const FitReference& reference, const FitFrame& frame, double front)
    : gluing_(gluing),
      frame_(frame),
      reference_(reference),
      front_(front),
      nearest_(2 * gluing.kind.size(), kNone),
      is_stuck_(gluing.kind.size(), 0) {}

void FoldPasses::repair(CodedImage& image, const RepairEffort& effort) {
    // What an earlier call found must not change the result.
    std::fill(nearest_.begin(), nearest_.end(), kNone);
    std::fill(is_stuck_.begin(), is_stuck_.end(), uint8_t{0});
    for (int pass = 0; pass < effort.passes; ++pass) {
        std::optional<FoldPass> state(std::in_place, *this, image, effort);
        const size_t coarse = pass == effort.passes / 2 ? state->run_coarse() : 0;
        if (coarse > 0) state.emplace(*this, image, effort);
        if (coarse + state->run() == 0) break;
    }
}

}  // namespace gim

// Finds changes of single details that mend folds around a cell. A change pays if what it saves in folds is worth more
// than what it adds in bits and in distance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "encoder/fit/coded_image.h"
#include "encoder/fit/detail_reach.h"
#include "encoder/fit/fold_state.h"

namespace gim {

// A component of a detail becomes greater by `by`.
struct DetailChange {
    PlaceInPart place;
    uint32_t component = 0;
    int32_t by = 0;
    Vec3 shift = Vec3::Zero();  // of a sample of weight 1, in the frame
    double cost = 0;            // bits; below 0 it pays
};

// Bits that a change must gain.
inline constexpr double kLeastFoldGain = 4;

class FoldChanges {
  public:
    // Keeps a reference to the state, and reads it as it is at each call. Several of these may work at once while nobody
    // changes it; they find the same.
    explicit FoldChanges(const FoldState& state);

    // Returns the best changes of details of these depths that gain enough, best first. Each is the best of its detail.
    // Cost: about a millisecond for depths 1 to 3.
    std::vector<DetailChange> best_around(uint32_t cell, uint32_t from_depth, uint32_t to_depth, size_t most);

    // What the change costs as things are now.
    double cost_of(const DetailChange& change);

    // The samples that a change of this detail moves. The reference holds until the next call.
    const DetailReach& reach_of(const PlaceInPart& place);

    // What it costs in distance, in bits, to move samples to x.
    double distance_cost_of(const std::vector<Vec3>& x, std::span<const uint32_t> samples);

  private:
    // From the reference, when the pass began. The reference counts as flat around a sample until the pass ends.
    struct Off {
        Vec3 normal = Vec3::Zero();
        double distance = 0;  // along the normal
    };
    // How much farther from the reference the samples get, in bits, if those of weight 1 shift by s: s b + s A s.
    struct DistanceCost {
        Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
        Vec3 b = Vec3::Zero();

        double of(const Vec3& shift) const { return shift.dot(b + a * shift); }
    };

    template <class Body>
    void for_each_place_near(const CellInPart& at, uint32_t depth, const Body& body);
    std::optional<DetailChange> best_of_detail(const PlaceInPart& place, double limit);
    // What the folds within reach cost after a shift. Stops adding above `most`.
    double fold_cost_after(const DetailReach& reach, const Vec3& shift, double most);
    double fold_cost_before(const DetailReach& reach) const;
    DistanceCost distance_cost(const DetailReach& reach);
    double bits_per_distance() const;
    Off off_now(uint32_t v);
    void follow_state();

    const FoldState& state_;
    ReachFinder reaches_;
    std::vector<Vec3> x_;           // of the state, but for the change that is being tried
    size_t followed_ = 0;           // moves of the state
    std::vector<uint32_t> off_at_;  // per sample: its place in offs_, or kNone
    std::vector<Off> offs_;
};

}  // namespace gim

// Leads samples back to their rails (encoder/image/rails.h).
#pragma once

#include <vector>

#include "encoder/image/rails.h"
#include "encoder/surface/closest_point.h"

namespace gim {

class RailGuide {
  public:
    explicit RailGuide(const Rails& rails);

    bool holds(uint32_t sample) const { return !curve_of_.empty() && curve_of_[sample] != kNone; }
    // The rest is for samples that it holds. Returns the nearest place on the rail.
    Vec3 nearest(uint32_t sample, const Vec3& place) const { return found(sample, place).point; }
    // Returns the direction of the rail there; zero if it is a point.
    Vec3 direction(uint32_t sample, const Vec3& place) const;

  private:
    ClosestPoint found(uint32_t sample, const Vec3& place) const { return trees_[curve_of_[sample]].find(place); }

    std::vector<Mesh> curves_;  // as triangles without area
    std::vector<ClosestPointTree> trees_;
    std::vector<uint32_t> curve_of_;
};

}  // namespace gim

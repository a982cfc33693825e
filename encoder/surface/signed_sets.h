// Union-find with signs: members of a set are alike or opposite to each other. The smallest member represents a set.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace gim {

class SignedSets {
  public:
    struct Place {
        uint32_t root;
        bool is_opposite;  // to the root
    };

    explicit SignedSets(size_t count) : parent_(count), is_opposite_(count, 0) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }

    Place find(uint32_t x) {
        Place place{x, false};
        while (parent_[place.root] != place.root) {
            place.is_opposite ^= is_opposite_[place.root] != 0;
            place.root = parent_[place.root];
        }
        for (bool sign = place.is_opposite; parent_[x] != place.root && x != place.root;) {  // shortens the path
            const uint32_t up = parent_[x];
            const bool step = is_opposite_[x] != 0;
            parent_[x] = place.root;
            is_opposite_[x] = sign;
            sign ^= step;
            x = up;
        }
        return place;
    }

    // Returns false, and changes nothing, if both are in one set and differ from what is asked.
    bool unite(uint32_t a, uint32_t b, bool are_opposite) {
        const Place p = find(a), q = find(b);
        const bool sign = p.is_opposite ^ q.is_opposite ^ are_opposite;
        if (p.root == q.root) return !sign;
        const auto [low, high] = std::minmax(p.root, q.root);
        parent_[high] = low;
        is_opposite_[high] = sign;
        return true;
    }

  private:
    std::vector<uint32_t> parent_;
    std::vector<uint8_t> is_opposite_;  // to the parent
};

}  // namespace gim

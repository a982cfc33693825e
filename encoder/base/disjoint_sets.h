// Union-find over 0 .. count-1. The smallest member represents a set, whatever the order of the unions.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace gim {

class DisjointSets {
  public:
    explicit DisjointSets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

    uint32_t find(uint32_t x) {
        while (parent_[x] != x) {
            parent_[x] = parent_[parent_[x]];
            x = parent_[x];
        }
        return x;
    }

    void unite(uint32_t a, uint32_t b) {
        a = find(a);
        b = find(b);
        if (a < b) {
            parent_[b] = a;
        } else {
            parent_[a] = b;
        }
    }

  private:
    std::vector<uint32_t> parent_;
};

}  // namespace gim

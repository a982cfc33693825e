// Things by where they are: a hash of the cells of a grid.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

class CellIndex {
  public:
    // size: of a cell, above 0.
    explicit CellIndex(double size) : size_(size) {}

    double size() const { return size_; }
    void add(const Vec3& place, uint32_t thing) { cells_[cell_of(place)].push_back(thing); }
    // Calls body(thing) for all that is less than a cell away, and for some of what is farther.
    template <class Body>
    void for_each_near(const Vec3& place, const Body& body) const {
        const Cell center = cell_of(place);
        for (int64_t k = 0; k < 27; ++k) {
            const auto at = cells_.find({center[0] + k % 3 - 1, center[1] + k / 3 % 3 - 1, center[2] + k / 9 - 1});
            if (at == cells_.end()) continue;
            for (const uint32_t thing : at->second) body(thing);
        }
    }

  private:
    using Cell = std::array<int64_t, 3>;
    struct CellHash {
        size_t operator()(const Cell& c) const {
            uint64_t hash = 0;
            for (const int64_t k : c) hash = (hash ^ static_cast<uint64_t>(k)) * 0x9E3779B97F4A7C15u;
            return static_cast<size_t>(hash ^ hash >> 32);
        }
    };

    Cell cell_of(const Vec3& place) const {
        const Vec3 p = place / size_;
        const auto number = [](double x) { return static_cast<int64_t>(std::clamp(std::floor(x), -0x1p60, 0x1p60)); };
        return {number(p.x()), number(p.y()), number(p.z())};
    }

    double size_;
    std::unordered_map<Cell, std::vector<uint32_t>, CellHash> cells_;
};

}  // namespace gim

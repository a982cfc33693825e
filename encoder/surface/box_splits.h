// Splits boxes into a binary tree by the surface-area heuristic: a query that opens only boxes near to it opens few.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

struct Box {
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    std::array<float, 3> low = {kInfinity, kInfinity, kInfinity};
    std::array<float, 3> high = {-kInfinity, -kInfinity, -kInfinity};

    void add(const Box& other) {
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], other.low[k]);
            high[k] = std::max(high[k], other.high[k]);
        }
    }
    float half_area() const {
        const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
        return x < 0 ? 0.0f : x * y + y * z + z * x;
    }
};

// What the tree sorts: a triangle of the mesh and its box.
struct BoxItem {
    Box box;
    std::array<float, 3> centre;
    uint32_t triangle;
};

// A binary split of a range of the leaf order, named by the position where it splits, which no other split has.
struct BoxSplit {
    Box left, right;
    uint32_t left_split, right_split;  // the splits of the two halves, or kNone where they are leaves
};

// Sorts the items into leaf order, leaves of up to four side by side. splits: becomes as long as items. Returns the top
// split, or kNone if all items are one leaf. The tree is at most about 48 + 32 deep. O(n log n).
uint32_t split_boxes(std::vector<BoxItem>& items, std::vector<BoxSplit>& splits, uint32_t threads);

// Of items begin .. end - 1.
Box bounds(const std::vector<BoxItem>& items, uint32_t begin, uint32_t end);

}  // namespace gim

// Splits boxes into a binary tree by the surface-area heuristic. A query that opens only nearby boxes opens few.
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

// An item that the tree sorts: a triangle of the mesh and its box.
struct BoxItem {
    Box box;
    std::array<float, 3> centre;
    uint32_t triangle;
};

// A binary split of a range of the leaf order. Its name is the position where it splits; no other split has it.
struct BoxSplit {
    Box left, right;
    uint32_t left_split, right_split;  // splits of the two halves; kNone for a leaf
};

// Sorts the items into leaf order: the items of a leaf, four at most, stand side by side. Makes `splits` as long as
// `items`. Returns the top split, or kNone if all items are one leaf. The tree is at most about 48 + 32 deep.
// O(n log n).
uint32_t split_boxes(std::vector<BoxItem>& items, std::vector<BoxSplit>& splits, uint32_t threads);

// Returns the box around items begin .. end - 1.
Box bounds(const std::vector<BoxItem>& items, uint32_t begin, uint32_t end);

}  // namespace gim

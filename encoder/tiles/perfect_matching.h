// Pairs all nodes of a graph so that the sum of the weights is largest (Edmonds' algorithm, by LEMON).
#pragma once

#include <cstdint>
#include <vector>

namespace gim {

struct WeightedEdge {
    uint32_t a, b;
    int64_t weight;
};

// Returns the partner of each node; nothing if some node must stay alone. O(n m log n).
std::vector<uint32_t> perfect_matching(uint32_t nodes, const std::vector<WeightedEdge>& edges);

}  // namespace gim

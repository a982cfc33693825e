#include "encoder/squares/share_sides.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <queue>
#include <utility>

namespace gim {

namespace {

constexpr int kLeastExponent = 2;
constexpr double kNearlyNext = 0.1;  // octaves that a side may be rounded up

uint64_t cells_of(int exponent) { return uint64_t{1} << (2 * exponent); }

}  // namespace

std::vector<uint32_t> share_sides(std::span<const double> areas, uint32_t side) {
    const int most = std::countr_zero(side - 1), least = std::min(kLeastExponent, most);
    const double all = std::accumulate(areas.begin(), areas.end(), 0.0);
    const uint64_t budget = cells_of(most);
    uint64_t used = 0;
    std::vector<int> exponents;
    using Entry = std::pair<double, uint32_t>;  // area per cell; counted from the last component
    std::priority_queue<Entry> sparsest;
    for (uint32_t k = 0; k < areas.size(); ++k) {
        const double share = all > 0 ? areas[k] / all : 1 / static_cast<double>(areas.size());
        const double ideal = share > 0 ? most + 0.5 * std::log2(share) : least;
        exponents.push_back(std::clamp(static_cast<int>(std::floor(ideal + kNearlyNext)), least, most));
        used += cells_of(exponents[k]);
        sparsest.push({share / static_cast<double>(cells_of(exponents[k])), UINT32_MAX - k});
    }
    while (!sparsest.empty()) {
        const auto [density, reversed] = sparsest.top();
        sparsest.pop();
        int& exponent = exponents[UINT32_MAX - reversed];
        const uint64_t more = 3 * cells_of(exponent);
        if (exponent == most || used + more > budget) break;
        used += more;
        ++exponent;
        sparsest.push({density / 4, reversed});
    }
    std::vector<uint32_t> sides;
    for (const int exponent : exponents) sides.push_back((1u << exponent) + 1);
    return sides;
}

}  // namespace gim

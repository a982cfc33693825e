#include "encoder/surface/weld_places.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "encoder/base/disjoint_sets.h"

namespace gim {

namespace {

constexpr double kFinest = 1e-7;  // of the diagonal

double squared_distance(const Point& a, const Point& b) {
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}

uint64_t hash_of(const std::array<int64_t, 3>& cell) {
    uint64_t hash = 0;
    for (const int64_t c : cell) hash = (hash ^ static_cast<uint64_t>(c)) * 0x9e3779b97f4a7c15ULL + (hash >> 29);
    return hash;
}

}  // namespace

std::vector<uint32_t> number_places(const std::vector<Point>& positions) {
    std::vector<uint32_t> order(positions.size());
    for (uint32_t v = 0; v < order.size(); ++v) order[v] = v;
    tbb::parallel_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return positions[a] != positions[b] ? positions[a] < positions[b] : a < b;
    });
    std::vector<uint32_t> place(positions.size());
    for (size_t k = 0; k < order.size(); ++k) {
        const bool same = k > 0 && positions[order[k]] == positions[order[k - 1]];
        place[order[k]] = same ? place[order[k - 1]] : order[k];
    }
    return place;
}

double resolution_of(const std::vector<Point>& positions) {
    if (positions.empty()) return 0;
    Point low = positions[0], high = positions[0];
    double largest = 0;
    bool are_floats = true;
    for (const Point& p : positions) {
        for (size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
            largest = std::max(largest, std::abs(p[k]));
            are_floats = are_floats && static_cast<double>(static_cast<float>(p[k])) == p[k];
        }
    }
    const double rounding = are_floats ? 0x1p-24 : 0x1p-53;
    return std::max(2 * rounding * largest, kFinest * std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]));
}

void unite_short_edges(const std::vector<Point>& positions, const std::vector<Triangle>& triangles, double tolerance,
                       std::vector<uint32_t>& place) {
    DisjointSets same(positions.size());
    for (const Triangle& t : triangles) {
        for (size_t i = 0; i < 3; ++i) {
            const uint32_t a = place[t[i]], b = place[t[(i + 1) % 3]];
            if (squared_distance(positions[a], positions[b]) <= tolerance * tolerance) same.unite(a, b);
        }
    }
    for (uint32_t& p : place) p = same.find(p);
}

uint64_t unite_near(const std::vector<Point>& positions, std::span<const uint32_t> candidates, double tolerance,
                    std::vector<uint32_t>& place) {
    if (!(tolerance > 0)) return 0;
    std::vector<uint32_t> places;
    for (const uint32_t v : candidates) places.push_back(place[v]);
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());

    // Cells as large as the tolerance: what is near lies in a neighbouring cell.
    Point low = positions[0];
    for (const Point& p : positions) {
        for (size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]);
    }
    const auto cell_of = [&](uint32_t p) {
        std::array<int64_t, 3> cell;
        for (size_t k = 0; k < 3; ++k)
            cell[k] = static_cast<int64_t>(std::min(std::floor((positions[p][k] - low[k]) / tolerance), 4e18));
        return cell;
    };
    std::unordered_multimap<uint64_t, uint32_t> grid;
    for (const uint32_t p : places) grid.emplace(hash_of(cell_of(p)), p);
    DisjointSets same(positions.size());
    for (const uint32_t p : places) {
        const std::array<int64_t, 3> cell = cell_of(p);
        for (int64_t i = 0; i < 27; ++i) {
            const auto range =
                grid.equal_range(hash_of({cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1}));
            for (auto it = range.first; it != range.second; ++it) {
                if (squared_distance(positions[p], positions[it->second]) <= tolerance * tolerance)
                    same.unite(p, it->second);
            }
        }
    }
    std::vector<uint8_t> is_long(positions.size(), 0);  // per root
    for (const uint32_t p : places) {
        if (squared_distance(positions[p], positions[same.find(p)]) > 4 * tolerance * tolerance)
            is_long[same.find(p)] = 1;
    }
    uint64_t gone = 0;
    for (uint32_t& p : place) {
        const uint32_t root = same.find(p);
        if (root == p || is_long[root]) continue;
        p = root;
    }
    for (const uint32_t p : places) gone += same.find(p) != p && !is_long[same.find(p)] ? 1 : 0;
    return gone;
}

}  // namespace gim

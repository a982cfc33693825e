// Drops faces that repeat others or have collapsed.
#pragma once

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// Drops the marked triangles. Returns their number.
uint64_t drop_marked(std::vector<Triangle>& triangles, std::span<const uint8_t> is_marked);

// name_of: gives a triangle's three names, vertices or places. count: goes up by the number of dropped triangles.
// Drops triangles that repeat a name.
template <class NameOf>
void drop_collapsed(std::vector<Triangle>& triangles, const NameOf& names_of, uint64_t& count) {
    count += std::erase_if(triangles, [&](const Triangle& t) {
        const Triangle n = names_of(t);
        return n[0] == n[1] || n[1] == n[2] || n[2] == n[0];
    });
}

// The names with the smallest first, in the same direction.
Triangle rotated(Triangle t);

// Drops triangles that have the names of an earlier one in the same direction, if they may go.
template <class NameOf, class MayGo>
void drop_duplicates(std::vector<Triangle>& triangles, const NameOf& names_of, const MayGo& may_go, uint64_t& count) {
    std::vector<std::pair<Triangle, uint32_t>> keys(triangles.size());
    for (uint32_t f = 0; f < triangles.size(); ++f) keys[f] = {rotated(names_of(triangles[f])), f};
    tbb::parallel_sort(keys.begin(), keys.end());
    std::vector<uint8_t> is_marked(triangles.size(), 0);
    for (size_t k = 1; k < keys.size(); ++k) {
        if (keys[k].first == keys[k - 1].first && may_go(keys[k].second)) is_marked[keys[k].second] = 1;
    }
    count += drop_marked(triangles, is_marked);
}

// Marks faces that lie on another face, the other way round, without solid between them: one of each pair in pieces of
// the surface that have only such faces. places: no two faces are equal. twin: as in FaceJoins. O(F log F).
std::vector<uint8_t> find_doubles(const std::vector<Triangle>& places, std::span<const uint32_t> twin);

}  // namespace gim

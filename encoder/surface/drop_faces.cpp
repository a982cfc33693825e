#include "encoder/surface/drop_faces.h"

#include "encoder/surface/join_faces.h"

namespace gim {

uint64_t drop_marked(std::vector<Triangle>& triangles, std::span<const uint8_t> is_marked) {
    size_t kept = 0;
    for (size_t f = 0; f < triangles.size(); ++f) {
        if (!is_marked[f]) triangles[kept++] = triangles[f];
    }
    const size_t dropped = triangles.size() - kept;
    triangles.resize(kept);
    return dropped;
}

Triangle rotated(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

std::vector<uint8_t> find_doubles(const std::vector<Triangle>& places, std::span<const uint32_t> twin) {
    std::vector<std::pair<Triangle, uint32_t>> keys(places.size());
    for (uint32_t f = 0; f < places.size(); ++f) {
        Triangle t = places[f];
        std::sort(t.begin(), t.end());
        keys[f] = {t, f};
    }
    tbb::parallel_sort(keys.begin(), keys.end());
    std::vector<uint32_t> partner(places.size(), kNone);
    for (size_t k = 1; k < keys.size(); ++k) {
        const uint32_t f = keys[k - 1].second, g = keys[k].second;
        if (keys[k].first != keys[k - 1].first || rotated(places[f]) == rotated(places[g])) continue;
        partner[f] = g;
        partner[g] = f;
    }
    const Components components = joined_components(twin);
    std::vector<uint8_t> is_double(components.count, 1);
    for (uint32_t f = 0; f < places.size(); ++f) {
        if (partner[f] == kNone) is_double[components.of_face[f]] = 0;
    }
    std::vector<uint8_t> is_marked(places.size(), 0);
    // The last pieces go first, so that what the file lists first stays.
    for (auto f = static_cast<uint32_t>(places.size()); f-- > 0;) {
        if (is_double[components.of_face[f]] && !is_marked[partner[f]]) is_marked[f] = 1;
    }
    return is_marked;
}

}  // namespace gim

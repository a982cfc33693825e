#include "encoder/surface/mesh.h"

#include <algorithm>
#include <utility>

namespace gim {

namespace {

// Pairs half-edges that run along the same edge, by sorting them on their (smaller, larger) vertex.
std::vector<uint32_t> pair_half_edges(const Mesh& mesh) {
    const auto count = static_cast<uint32_t>(3 * mesh.triangles.size());
    std::vector<std::pair<uint64_t, uint32_t>> keys(count);
    for (uint32_t h = 0; h < count; ++h) {
        const uint64_t a = from(mesh, h), b = to(mesh, h);
        keys[h] = {std::min(a, b) << 32 | std::max(a, b), h};
    }
    std::sort(keys.begin(), keys.end());
    std::vector<uint32_t> twin(count, kNone);
    for (uint32_t k = 0; k + 1 < count; ++k) {
        if (keys[k].first != keys[k + 1].first) continue;
        twin[keys[k].second] = keys[k + 1].second;
        twin[keys[k + 1].second] = keys[k].second;
        ++k;
    }
    return twin;
}

}  // namespace

Topology build_topology(const Mesh& mesh) {
    Topology topology{pair_half_edges(mesh), std::vector<uint32_t>(mesh.positions.size(), kNone)};
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        uint32_t& out = topology.outgoing[from(mesh, h)];
        if (out == kNone || topology.twin[h] == kNone) out = h;
    }
    return topology;
}

}  // namespace gim

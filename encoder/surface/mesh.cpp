#include "encoder/surface/mesh.h"

#include "encoder/surface/topology_summary.h"

namespace gim {

namespace {

// Pairs the half-edges that run along the same edge.
std::vector<uint32_t> pair_half_edges(const Mesh& mesh) {
    std::vector<uint32_t> twin(3 * mesh.triangles.size(), kNone);
    const EdgeTable edges = build_edge_table(mesh.triangles, mesh.positions.size());
    for (size_t e = 0; e < edges.size(); ++e) {
        const auto around = edges.around(e);
        for (size_t k = 0; k + 1 < around.size(); k += 2) {
            twin[around[k]] = around[k + 1];
            twin[around[k + 1]] = around[k];
        }
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

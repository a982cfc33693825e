#include "encoder/tiles/crease_graph.h"

#include <algorithm>

namespace gim {

CreaseGraph::CreaseGraph(const Mesh& mesh, const std::vector<bool>& sharp)
    : neighbours_(mesh.positions.size()), boundary_(mesh.positions.size(), false) {
    const Topology topology = build_topology(mesh);
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        const uint32_t t = topology.twin[h];
        if (t == kNone) {
            boundary_[from(mesh, h)] = boundary_[to(mesh, h)] = true;
        } else if (h < t && !sharp.empty() && (sharp[h] || sharp[t])) {
            join(from(mesh, h), to(mesh, h));
        }
    }
}

bool CreaseGraph::joined(uint32_t a, uint32_t b) const {
    return std::find(neighbours_[a].begin(), neighbours_[a].end(), b) != neighbours_[a].end();
}

void CreaseGraph::join(uint32_t a, uint32_t b) {
    neighbours_[a].push_back(b);
    neighbours_[b].push_back(a);
}

void CreaseGraph::part(uint32_t a, uint32_t b) {
    std::erase(neighbours_[a], b);
    std::erase(neighbours_[b], a);
}

void CreaseGraph::collapse(const HalfEdgeCollapse& collapse) {
    const uint32_t v = collapse.vertex, u = collapse.into;
    const std::vector<uint32_t> around = neighbours_[v];
    Step step{v, u, kNone};
    for (const uint32_t w : around) part(v, w);
    if (around.size() == 2 && !boundary_[v] && (around[0] == u || around[1] == u)) {
        const uint32_t other = around[around[0] == u ? 1 : 0];
        if (!joined(u, other)) {
            join(u, other);
            step.other = other;
        }
    }
    steps_.push_back(step);
}

void CreaseGraph::undo_all() {
    for (; !steps_.empty(); steps_.pop_back()) {
        const Step& step = steps_.back();
        if (step.other == kNone || !joined(step.into, step.other)) continue;
        part(step.into, step.other);
        join(step.into, step.vertex);
        join(step.vertex, step.other);
    }
}

std::vector<std::array<uint32_t, 2>> CreaseGraph::edges() const {
    std::vector<std::array<uint32_t, 2>> edges;
    for (uint32_t v = 0; v < neighbours_.size(); ++v) {
        for (const uint32_t w : neighbours_[v]) {
            if (v < w) edges.push_back({v, w});
        }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

std::vector<VertexKind> CreaseGraph::kinds() const {
    std::vector<VertexKind> kinds(neighbours_.size(), VertexKind::kSmooth);
    for (uint32_t v = 0; v < kinds.size(); ++v) {
        const size_t features = neighbours_[v].size() + (boundary_[v] ? 2 : 0);
        if (features != 0) kinds[v] = features == 2 ? VertexKind::kCrease : VertexKind::kCorner;
    }
    return kinds;
}

}  // namespace gim

#include "encoder/surface/edge_paths.h"

#include <algorithm>
#include <limits>

namespace gim {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<uint32_t> shortest_path(const Mesh& mesh, const Topology& topology, const std::vector<uint32_t>& sources,
                                    const std::vector<uint8_t>& goal, const std::vector<uint8_t>& allowed) {
    std::vector<double> distance(mesh.positions.size(), kInfinity);
    std::vector<uint32_t> arrival(mesh.positions.size(), kNone);  // half-edge that reaches the vertex
    std::vector<uint8_t> done(mesh.positions.size(), 0);
    MinQueue queue;
    for (const uint32_t v : sources) {
        distance[v] = 0;
        queue.push({0, v});
    }
    const auto relax = [&](uint32_t v, uint32_t w, uint32_t h) {
        if (done[w] || !(allowed[w] || goal[w])) return;
        const double d = distance[v] + (mesh.positions[v] - mesh.positions[w]).norm();
        if (d >= distance[w]) return;
        distance[w] = d;
        arrival[w] = h;
        queue.push({d, w});
    };
    while (!queue.empty()) {
        const uint32_t v = queue.top().element;
        queue.pop();
        if (done[v]) continue;
        done[v] = 1;
        if (goal[v] && arrival[v] != kNone) {
            std::vector<uint32_t> path;
            for (uint32_t at = v; arrival[at] != kNone; at = from(mesh, path.back())) path.push_back(arrival[at]);
            std::reverse(path.begin(), path.end());
            return path;
        }
        // A closed path (both ends are one vertex) may not leave through a boundary edge, because those carry no mark.
        for_each_outgoing(topology, v, [&](uint32_t h) {
            if (topology.twin[h] != kNone) relax(v, to(mesh, h), h);
        });
    }
    return {};
}

std::vector<double> edge_distance(const Mesh& mesh, const Topology& topology, const std::vector<uint32_t>& sources) {
    std::vector<double> distance(mesh.positions.size(), kInfinity);
    std::vector<uint8_t> done(mesh.positions.size(), 0);
    MinQueue queue;
    for (const uint32_t v : sources) {
        distance[v] = 0;
        queue.push({0, v});
    }
    while (!queue.empty()) {
        const uint32_t v = queue.top().element;
        queue.pop();
        if (done[v]) continue;
        done[v] = 1;
        const auto relax = [&](uint32_t w) {
            const double reach = distance[v] + (mesh.positions[v] - mesh.positions[w]).norm();
            if (reach >= distance[w]) return;
            distance[w] = reach;
            queue.push({reach, w});
        };
        for_each_outgoing(topology, v, [&](uint32_t h) {
            relax(to(mesh, h));
            if (topology.twin[prev(h)] == kNone) relax(from(mesh, prev(h)));
        });
    }
    return distance;
}

double path_length(const Mesh& mesh, const std::vector<uint32_t>& half_edges) {
    double length = 0;
    for (const uint32_t h : half_edges) length += (mesh.positions[to(mesh, h)] - mesh.positions[from(mesh, h)]).norm();
    return length;
}

}  // namespace gim

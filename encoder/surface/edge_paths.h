// Paths and distances along the edges of a mesh (Dijkstra).
#pragma once

#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// An element with its distance. A queue gives the nearest first; equally near ones come by number.
struct QueueEntry {
    double distance;
    uint32_t element;
    bool operator>(const QueueEntry& o) const {
        return distance != o.distance ? distance > o.distance : element > o.element;
    }
};
using MinQueue = std::priority_queue<QueueEntry, std::vector<QueueEntry>, std::greater<>>;

// Returns the shortest edge path from any vertex of `sources` to a vertex v with goal[v], through vertices with
// allowed[v] (goals need not be allowed). The path is a list of half-edges in order, empty if there is none. Its length
// is measured in object units. O(E log E).
std::vector<uint32_t> shortest_path(const Mesh& mesh, const Topology& topology, const std::vector<uint32_t>& sources,
                                    const std::vector<uint8_t>& goal, const std::vector<uint8_t>& allowed);

// Returns for each vertex the distance along edges from the nearest source. O(E log E).
std::vector<double> edge_distance(const Mesh& mesh, const Topology& topology, const std::vector<uint32_t>& sources);

// Returns the length in object units.
double path_length(const Mesh& mesh, const std::vector<uint32_t>& half_edges);

// Calls visit(h) for every half-edge that leaves v. A boundary edge whose half-edge enters v is not visited.
template <class Visit>
void for_each_outgoing(const Topology& topology, uint32_t v, Visit&& visit) {
    const uint32_t first = topology.outgoing[v];
    uint32_t h = first;
    while (h != kNone) {
        visit(h);
        h = topology.twin[prev(h)];
        if (h == first) break;
    }
}

}  // namespace gim

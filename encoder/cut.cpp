#include "encoder/cut.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace gim {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct QueueEntry {
    double distance;
    uint32_t element;
    bool operator>(const QueueEntry& o) const {
        return distance != o.distance ? distance > o.distance : element > o.element;
    }
};
using MinQueue = std::priority_queue<QueueEntry, std::vector<QueueEntry>, std::greater<>>;

Vec3 centroid(const Mesh& mesh, uint32_t f) {
    const Triangle& t = mesh.triangles[f];
    return (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3;
}

// Phase 1: grows a disk from the seed, nearest triangle first. What is never crossed is the cut.
// Returns the triangle reached last too: the farthest from the seed.
CutEdges remove_triangles(const Mesh& mesh, const Topology& topology, uint32_t seed, uint32_t& farthest) {
    CutEdges cut(topology.twin.size(), 1);
    std::vector<double> distance(mesh.triangles.size(), kInfinity);
    std::vector<uint32_t> entry(mesh.triangles.size(), kNone);  // the half-edge of the neighbour that was crossed
    std::vector<uint8_t> done(mesh.triangles.size(), 0);
    MinQueue queue;
    distance[seed] = 0;
    queue.push({0, seed});
    while (!queue.empty()) {
        const uint32_t f = queue.top().element;
        queue.pop();
        if (done[f]) continue;
        done[f] = 1;
        farthest = f;
        if (entry[f] != kNone) cut[entry[f]] = cut[topology.twin[entry[f]]] = 0;
        for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
            if (topology.twin[h] == kNone) continue;
            const uint32_t g = face_of(topology.twin[h]);
            const double d = distance[f] + (centroid(mesh, f) - centroid(mesh, g)).norm();
            if (done[g] || d >= distance[g]) continue;
            distance[g] = d;
            entry[g] = h;
            queue.push({d, g});
        }
    }
    return cut;
}

// Phase 2: removes dangling edges until only loops remain.
void trim(const Mesh& mesh, const Topology& topology, CutEdges& cut) {
    std::vector<uint32_t> valence = cut_valence(mesh, topology, cut);
    std::vector<uint32_t> leaves;
    for (uint32_t v = 0; v < valence.size(); ++v) {
        if (valence[v] == 1) leaves.push_back(v);
    }
    while (!leaves.empty()) {
        const uint32_t v = leaves.back();
        leaves.pop_back();
        if (valence[v] != 1) continue;
        for_each_outgoing(topology, v, [&](uint32_t h) {
            if (topology.twin[h] == kNone || !cut[h]) return;
            cut[h] = cut[topology.twin[h]] = 0;
            const uint32_t w = to(mesh, h);
            --valence[v];
            if (--valence[w] == 1) leaves.push_back(w);
        });
    }
}

// Vertices within `radius` of the path's vertices, along edges.
std::vector<uint8_t> band(const Mesh& mesh, const Topology& topology, const std::vector<uint32_t>& path,
                          double radius) {
    std::vector<uint8_t> inside(mesh.positions.size(), 0);
    std::vector<double> distance(mesh.positions.size(), kInfinity);
    MinQueue queue;
    for (const uint32_t h : path) {
        for (const uint32_t v : {from(mesh, h), to(mesh, h)}) {
            if (distance[v] == 0) continue;
            distance[v] = 0;
            queue.push({0, v});
        }
    }
    while (!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if (inside[v]) continue;
        inside[v] = 1;
        for_each_outgoing(topology, v, [&](uint32_t h) {
            const uint32_t w = to(mesh, h);
            const double reach = d + (mesh.positions[v] - mesh.positions[w]).norm();
            if (reach > radius || reach >= distance[w]) return;
            distance[w] = reach;
            queue.push({reach, w});
        });
    }
    return inside;
}

double path_length(const Mesh& mesh, const std::vector<uint32_t>& path) {
    double length = 0;
    for (const uint32_t h : path) length += (mesh.positions[to(mesh, h)] - mesh.positions[from(mesh, h)]).norm();
    return length;
}

// Every cut-path once (not its mate), as half-edges of M in order; input boundaries left out. A path that returns to
// its own cut-node comes in two halves, so that its ends differ.
std::vector<std::vector<uint32_t>> cut_paths(const Mesh& mesh, const Topology& topology, const CutEdges& cut) {
    const std::vector<uint32_t> valence = cut_valence(mesh, topology, cut);
    std::vector<uint8_t> seen(topology.twin.size(), 0);
    std::vector<std::vector<uint32_t>> paths;
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        if (topology.twin[h] == kNone || !cut[h] || seen[h] || valence[from(mesh, h)] == 2) continue;
        std::vector<uint32_t> path;
        for (uint32_t e = h;; e = next_on_cut(topology, cut, e)) {
            path.push_back(e);
            seen[e] = seen[topology.twin[e]] = 1;
            if (valence[to(mesh, e)] != 2) break;
        }
        if (from(mesh, path.front()) == to(mesh, path.back())) {
            const auto middle = path.begin() + static_cast<std::ptrdiff_t>(path.size() / 2);
            paths.emplace_back(path.begin(), middle);
            path.erase(path.begin(), middle);
        }
        paths.push_back(std::move(path));
    }
    return paths;
}

// A shorter replacement for `path` within `inside`, or an empty path.
std::vector<uint32_t> shorter_path(const Mesh& mesh, const Topology& topology, const CutEdges& rest,
                                   const std::vector<uint32_t>& path, std::vector<uint8_t> inside) {
    const std::vector<uint32_t> valence = cut_valence(mesh, topology, rest);
    for (size_t v = 0; v < inside.size(); ++v) inside[v] = inside[v] && valence[v] == 0;
    std::vector<uint8_t> goal(mesh.positions.size(), 0);
    goal[to(mesh, path.back())] = 1;
    std::vector<uint32_t> found = shortest_path(mesh, topology, {from(mesh, path.front())}, goal, inside);
    if (found.empty() || path_length(mesh, found) >= path_length(mesh, path) * (1 - 1e-9)) return {};
    return found;
}

}  // namespace

void mark_path(const Topology& topology, const std::vector<uint32_t>& half_edges, uint8_t value, CutEdges& cut) {
    for (const uint32_t h : half_edges) {
        cut[h] = value;
        if (topology.twin[h] != kNone) cut[topology.twin[h]] = value;
    }
}

double cut_length(const Mesh& mesh, const Topology& topology, const CutEdges& cut) {
    double length = 0;
    for (uint32_t h = 0; h < cut.size(); ++h) {
        if (cut[h] && topology.twin[h] != kNone && h < topology.twin[h]) {
            length += (mesh.positions[to(mesh, h)] - mesh.positions[from(mesh, h)]).norm();
        }
    }
    return length;
}

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
        // A closed path (both ends the same vertex) may not leave through a boundary edge: those carry no mark.
        for_each_outgoing(topology, v, [&](uint32_t h) {
            if (topology.twin[h] != kNone) relax(v, to(mesh, h), h);
        });
    }
    return {};
}

CutEdges initial_cut(const Mesh& mesh, const Topology& topology, uint32_t seed_triangle) {
    uint32_t farthest = seed_triangle;
    CutEdges cut = remove_triangles(mesh, topology, seed_triangle, farthest);
    for (uint32_t h = 0; h < cut.size(); ++h) cut[h] = cut[h] && topology.twin[h] != kNone;
    trim(mesh, topology, cut);
    const bool has_boundary =
        std::any_of(topology.twin.begin(), topology.twin.end(), [](uint32_t t) { return t == kNone; });
    if (!has_boundary && std::none_of(cut.begin(), cut.end(), [](uint8_t c) { return c != 0; })) {
        mark_path(topology, {3 * farthest, 3 * farthest + 1}, 1, cut);
    }
    return cut;
}

CutEdges straighten_cut(const Mesh& mesh, const Topology& topology, const CutEdges& cut) {
    CutEdges result = cut;
    for (const std::vector<uint32_t>& path : cut_paths(mesh, topology, cut)) {
        CutEdges rest = result;
        mark_path(topology, path, 0, rest);
        const double length = path_length(mesh, path);
        for (const double radius : {kInfinity, length / 4, length / 16, length / 64}) {
            const std::vector<uint8_t> inside = radius == kInfinity ? std::vector<uint8_t>(mesh.positions.size(), 1)
                                                                    : band(mesh, topology, path, radius);
            const std::vector<uint32_t> found = shorter_path(mesh, topology, rest, path, inside);
            if (found.empty()) continue;
            CutEdges trial = rest;
            mark_path(topology, found, 1, trial);
            if (!opens_to_disk(mesh, topology, trial)) continue;
            result = std::move(trial);
            break;
        }
    }
    return result;
}

}  // namespace gim

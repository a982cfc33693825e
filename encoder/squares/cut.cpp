#include "encoder/squares/cut.h"

#include <algorithm>
#include <limits>

namespace gim {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3 centroid(const Mesh& mesh, uint32_t f) {
    const Triangle& t = mesh.triangles[f];
    return (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3;
}

// Phase 1: grows a disk from the seed, nearest triangle first. The edges that are never crossed are the cut.
// `farthest` becomes the triangle that is reached last.
CutEdges remove_triangles(const Mesh& mesh, const Topology& topology, uint32_t seed, uint32_t& farthest) {
    CutEdges cut(topology.twin.size(), 1);
    std::vector<double> distance(mesh.triangles.size(), kInfinity);
    std::vector<uint32_t> entry(mesh.triangles.size(), kNone);  // the neighbour's half-edge that was crossed to enter
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

std::vector<uint32_t> vertices_of(const Mesh& mesh, const std::vector<uint32_t>& path) {
    std::vector<uint32_t> vertices{from(mesh, path.front())};
    for (const uint32_t h : path) vertices.push_back(to(mesh, h));
    return vertices;
}

// Returns every cut-path once, without its mate, as half-edges of M in order. Leaves out input boundaries. Paths end at
// cut-nodes and at fixed vertices. A path that returns to its own begin is split in two halves, so that its ends
// differ.
std::vector<std::vector<uint32_t>> cut_paths(const Mesh& mesh, const Topology& topology, const CutEdges& cut,
                                             const std::vector<uint32_t>& fixed) {
    const std::vector<uint32_t> valence = cut_valence(mesh, topology, cut);
    std::vector<uint8_t> end(valence.size());
    for (size_t v = 0; v < end.size(); ++v) end[v] = valence[v] != 2;
    for (const uint32_t v : fixed) end[v] = 1;
    std::vector<uint8_t> seen(topology.twin.size(), 0);
    std::vector<std::vector<uint32_t>> paths;
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        if (topology.twin[h] == kNone || !cut[h] || seen[h] || !end[from(mesh, h)]) continue;
        std::vector<uint32_t> path;
        for (uint32_t e = h;; e = next_on_cut(topology, cut, e)) {
            path.push_back(e);
            seen[e] = seen[topology.twin[e]] = 1;
            if (end[to(mesh, e)]) break;
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

// Returns a shorter replacement for `path` within `inside`. Empty if there is none.
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

// Finds the boundary loop of each vertex, numbered from 0; kNone inside. Returns the number of loops.
uint32_t label_loops(const Mesh& mesh, const Topology& topology, std::vector<uint32_t>& loop) {
    loop.assign(mesh.positions.size(), kNone);
    uint32_t count = 0;
    for (uint32_t v = 0; v < loop.size(); ++v) {
        const uint32_t first = topology.outgoing[v];
        if (first == kNone || topology.twin[first] != kNone || loop[v] != kNone) continue;
        for (uint32_t w = v; loop[w] == kNone; w = to(mesh, topology.outgoing[w])) loop[w] = count;
        ++count;
    }
    return count;
}

// Returns the shortest path that joins the two boundary loops of the surface opened along `rest`. Empty if there are
// not two. Faces keep their numbers when a mesh is split, so the half-edges are those of the mesh itself.
std::vector<uint32_t> bridge_loops(const Mesh& mesh, const Topology& topology, const CutEdges& rest) {
    const SplitMesh split = split_along(mesh, topology, rest);
    const Topology opened = build_topology(split.mesh);
    std::vector<uint32_t> loop;
    if (label_loops(split.mesh, opened, loop) != 2) return {};
    std::vector<uint32_t> sources;
    std::vector<uint8_t> goal(loop.size()), inside(loop.size());
    for (uint32_t v = 0; v < loop.size(); ++v) {
        if (loop[v] == 0) sources.push_back(v);
        goal[v] = loop[v] == 1;
        inside[v] = loop[v] == kNone;
    }
    return shortest_path(split.mesh, opened, sources, goal, inside);
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

CutEdges straighten_cut(const Mesh& mesh, const Topology& topology, const CutEdges& cut,
                        const StraightenOptions& options) {
    CutEdges result = cut;
    for (const std::vector<uint32_t>& path : cut_paths(mesh, topology, cut, options.fixed)) {
        CutEdges rest = result;
        mark_path(topology, path, 0, rest);
        const double length = path_length(mesh, path);
        const std::vector<double> distance = edge_distance(mesh, topology, vertices_of(mesh, path));
        for (const double part : {1.0, 0.25, 1.0 / 16, 1.0 / 64}) {
            const double radius = part < 1 ? part * std::min(options.widest, length) : options.widest;
            std::vector<uint8_t> inside(mesh.positions.size());
            for (size_t v = 0; v < inside.size(); ++v) inside[v] = distance[v] <= radius;
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

CutEdges shorten_cut(const Mesh& mesh, const Topology& topology, const CutEdges& cut) {
    constexpr int kMostPasses = 8;
    constexpr double kLeastGain = 1e-3;  // as a part of the path's length
    CutEdges result = cut;
    for (int pass = 0; pass < kMostPasses; ++pass) {
        bool gained = false;
        for (const std::vector<uint32_t>& path : cut_paths(mesh, topology, result, {})) {
            // An earlier exchange may have removed a part of this path, or put a new cut-node in its middle.
            if (std::any_of(path.begin(), path.end(), [&](uint32_t h) { return !result[h]; })) continue;
            CutEdges rest = result;
            mark_path(topology, path, 0, rest);
            const std::vector<uint32_t> bridge = bridge_loops(mesh, topology, rest);
            if (bridge.empty() || path_length(mesh, bridge) > (1 - kLeastGain) * path_length(mesh, path)) continue;
            mark_path(topology, bridge, 1, rest);
            trim(mesh, topology, rest);
            if (!opens_to_disk(mesh, topology, rest)) continue;
            result = std::move(rest);
            gained = true;
        }
        if (!gained) break;
    }
    return result;
}

}  // namespace gim

#include "encoder/squares/open_mesh.h"

#include <algorithm>
#include <string>

namespace gim {

uint32_t next_on_cut(const Topology& topology, const CutEdges& cut, uint32_t h) {
    h = next(h);
    while (!is_cut(topology, cut, h)) h = next(topology.twin[h]);
    return h;
}

std::vector<uint32_t> cut_valence(const Mesh& mesh, const Topology& topology, const CutEdges& cut) {
    std::vector<uint32_t> valence(mesh.positions.size(), 0);
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        const bool counted_once = topology.twin[h] == kNone || (cut[h] && h < topology.twin[h]);
        if (counted_once) ++valence[from(mesh, h)], ++valence[to(mesh, h)];
    }
    return valence;
}

namespace {

struct CutCounts {
    uint32_t boundary_half_edges = 0, first = kNone;
    uint32_t loop_length = 0;
    int64_t euler = 0;
};

// Counts M' without building it: a vertex with k sectors between cut edges gets k copies.
CutCounts count_opened(const Mesh& mesh, const Topology& topology, const CutEdges& cut) {
    CutCounts counts;
    std::vector<uint32_t> sectors(mesh.positions.size(), 0);
    std::vector<uint8_t> used(mesh.positions.size(), 0);
    int64_t edges = 0;
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        used[from(mesh, h)] = 1;
        if (is_cut(topology, cut, h)) {
            ++counts.boundary_half_edges;
            if (counts.first == kNone) counts.first = h;
            ++sectors[from(mesh, h)];
            ++edges;
        } else if (h < topology.twin[h]) {
            ++edges;
        }
    }
    int64_t vertices = 0;
    for (size_t v = 0; v < used.size(); ++v) vertices += used[v] ? std::max(1u, sectors[v]) : 0;
    counts.euler = vertices - edges + static_cast<int64_t>(mesh.triangles.size());
    if (counts.first != kNone) {
        uint32_t h = counts.first;
        do {
            ++counts.loop_length;
            h = next_on_cut(topology, cut, h);
        } while (h != counts.first);
    }
    return counts;
}

}  // namespace

bool opens_to_disk(const Mesh& mesh, const Topology& topology, const CutEdges& cut) {
    // A connected surface with one boundary loop and Euler characteristic 1 is a disk. If both hold, the opened surface
    // is connected: a second component would bring a loop of its own, or a closed surface of another characteristic.
    const CutCounts counts = count_opened(mesh, topology, cut);
    return counts.first != kNone && counts.loop_length == counts.boundary_half_edges && counts.euler == 1;
}

SplitMesh split_along(const Mesh& mesh, const Topology& topology, const CutEdges& cut) {
    SplitMesh split;
    split.mesh.triangles.assign(mesh.triangles.size(), {kNone, kNone, kNone});
    const auto add_copy = [&](uint32_t v) {
        split.mesh.positions.push_back(mesh.positions[v]);
        split.source.push_back(v);
        return static_cast<uint32_t>(split.source.size() - 1);
    };
    const auto corner = [&](uint32_t h) -> uint32_t& { return split.mesh.triangles[face_of(h)][h % 3]; };

    // Each sector between two cut edges becomes one vertex. The walk starts at the half-edge with the cut on its right
    // and goes left.
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        if (!is_cut(topology, cut, h)) continue;
        const uint32_t copy = add_copy(from(mesh, h));
        for (uint32_t out = h;;) {
            corner(out) = copy;
            if (is_cut(topology, cut, prev(out))) break;
            out = topology.twin[prev(out)];
        }
    }
    std::vector<uint32_t> interior(mesh.positions.size(), kNone);
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        if (corner(h) != kNone) continue;
        uint32_t& copy = interior[from(mesh, h)];
        if (copy == kNone) copy = add_copy(from(mesh, h));
        corner(h) = copy;
    }
    return split;
}

Result<OpenedMesh> open_mesh(const Mesh& mesh, const Topology& topology, const CutEdges& cut) {
    const CutCounts counts = count_opened(mesh, topology, cut);
    if (counts.first == kNone) return Error{Stage::kCut, "the cut is empty: a closed surface has to be cut open"};
    if (counts.loop_length != counts.boundary_half_edges || counts.euler != 1) {
        return Error{
            Stage::kCut,
            "the cut does not open the mesh into a disk (Euler characteristic " + std::to_string(counts.euler) + ", " +
                (counts.loop_length == counts.boundary_half_edges ? "one boundary loop)" : "several boundary loops)")};
    }

    SplitMesh split = split_along(mesh, topology, cut);
    OpenedMesh opened;
    opened.mesh = std::move(split.mesh);
    opened.source = std::move(split.source);
    const auto corner = [&](uint32_t h) { return opened.mesh.triangles[face_of(h)][h % 3]; };

    // A vertex is a cut-node if the cut's valence there is not 2.
    const std::vector<uint32_t> valence = cut_valence(mesh, topology, cut);
    std::vector<uint32_t> half_edges;
    half_edges.reserve(counts.loop_length);
    uint32_t h = counts.first;
    do {
        half_edges.push_back(h);
        h = next_on_cut(topology, cut, h);
    } while (h != counts.first);
    const auto is_node = [&](size_t i) { return valence[from(mesh, half_edges[i])] != 2; };
    size_t start = 0;
    while (start < half_edges.size() && !is_node(start)) ++start;
    const bool no_node = start == half_edges.size();  // a disk; its boundary is one path and may start anywhere
    std::rotate(half_edges.begin(), half_edges.begin() + static_cast<std::ptrdiff_t>(no_node ? 0 : start),
                half_edges.end());

    std::vector<uint32_t> path_of(topology.twin.size(), kNoMate);
    for (size_t i = 0; i < half_edges.size(); ++i) {
        opened.loop.push_back(corner(half_edges[i]));
        if (i == 0 || is_node(i)) {
            opened.paths.push_back({static_cast<uint32_t>(i), kNoMate, from(mesh, half_edges[i]), 0});
        }
        path_of[half_edges[i]] = static_cast<uint32_t>(opened.paths.size() - 1);
    }
    for (size_t k = 0; k < opened.paths.size(); ++k) {
        BoundaryPath& path = opened.paths[k];
        path.end_node = opened.paths[(k + 1) % opened.paths.size()].begin_node;
        const uint32_t twin = topology.twin[half_edges[path.first]];
        path.mate = twin == kNone ? kNoMate : path_of[twin];
    }
    return opened;
}

}  // namespace gim

#include "encoder/tiles/even_patches.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "encoder/base/disjoint_sets.h"

namespace gim {

using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

namespace {

// More collapses than that are no repair.
constexpr int kMostCollapses = 100;

// Patches are numbered by their first face. What lies beyond the boundaries counts as one patch that is never odd.
struct Patches {
    std::vector<uint32_t> of_face;
    std::vector<bool> odd;
    uint32_t outside;
};

Patches find_patches(const CollapseMesh& mesh) {
    const auto faces = static_cast<uint32_t>(mesh.n_faces());
    DisjointSets sets(faces);
    for (const EdgeHandle e : mesh.edges()) {
        if (mesh.is_feature(e)) continue;
        sets.unite(index(mesh.face_handle(mesh.halfedge_handle(e, 0))),
                   index(mesh.face_handle(mesh.halfedge_handle(e, 1))));
    }
    Patches patches{std::vector<uint32_t>(faces, kNone), std::vector<bool>(faces + 1, false), faces};
    for (const FaceHandle f : mesh.faces()) {
        const uint32_t patch = patches.of_face[index(f)] = sets.find(index(f));
        patches.odd[patch] = !patches.odd[patch];
    }
    return patches;
}

// A collapse that takes a face from patches a and b.
struct Bridge {
    uint32_t a, b;
    double cost;
    HalfedgeHandle edge;
};

std::vector<Bridge> find_bridges(Decimator& decimator, const Patches& patches) {
    const CollapseMesh& mesh = decimator.mesh();
    const auto patch = [&](HalfedgeHandle h) {
        return mesh.is_boundary(h) ? patches.outside : patches.of_face[index(mesh.face_handle(h))];
    };
    std::vector<Bridge> bridges;
    for (const EdgeHandle e : mesh.edges()) {
        if (!mesh.is_feature(e)) continue;
        for (const HalfedgeHandle h : {mesh.halfedge_handle(e, 0), mesh.halfedge_handle(e, 1)}) {
            const uint32_t a = patch(h), b = patch(mesh.opposite_halfedge_handle(h));
            if (a == b || mesh.feature_count(mesh.from_vertex_handle(h)) != 2) continue;
            if (const auto cost = decimator.cost_of(h)) bridges.push_back({a, b, *cost, h});
        }
    }
    return bridges;
}

// The cheapest way from a patch to another odd one, or outside.
struct Way {
    double cost = HUGE_VAL;
    HalfedgeHandle first;
};

Way cheapest_way(uint32_t start, const Patches& patches, const std::vector<std::vector<Bridge>>& from) {
    using Entry = std::pair<double, uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::vector<Way> best(from.size());
    best[start].cost = 0;
    queue.push({0, start});
    while (!queue.empty()) {
        const auto [cost, patch] = queue.top();
        queue.pop();
        if (cost > best[patch].cost) continue;
        if (patch != start && (patch == patches.outside || patches.odd[patch])) return best[patch];
        for (const Bridge& bridge : from[patch]) {
            Way& there = best[bridge.b];
            if (cost + bridge.cost >= there.cost) continue;
            there = {cost + bridge.cost, patch == start ? bridge.edge : best[patch].first};
            queue.push({there.cost, bridge.b});
        }
    }
    return Way();
}

}  // namespace

bool make_patches_even(Decimator& decimator) {
    for (int made = 0;; ++made) {
        const Patches patches = find_patches(decimator.mesh());
        if (std::find(patches.odd.begin(), patches.odd.end(), true) == patches.odd.end()) return true;
        if (made == kMostCollapses) return false;
        std::vector<std::vector<Bridge>> from(patches.odd.size());
        for (const Bridge& b : find_bridges(decimator, patches)) {
            from[b.a].push_back(b);
            from[b.b].push_back({b.b, b.a, b.cost, b.edge});
        }
        // One step at a time, because each collapse changes what the others cost.
        Way best;
        for (uint32_t patch = 0; patch < patches.outside; ++patch) {
            if (!patches.odd[patch]) continue;
            const Way way = cheapest_way(patch, patches, from);
            if (way.cost < best.cost) best = way;
        }
        if (!best.first.is_valid()) return false;
        decimator.collapse(best.first);
    }
}

}  // namespace gim

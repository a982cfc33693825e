// Connectivity of a triangle list (topology_summary.h).
#include "encoder/surface/topology_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "encoder/base/disjoint_sets.h"

namespace gim {

namespace {

uint32_t start_of(std::span<const Triangle> triangles, uint32_t h) { return triangles[h / 3][h % 3]; }
uint32_t end_of(std::span<const Triangle> triangles, uint32_t h) { return triangles[h / 3][(h % 3 + 1) % 3]; }

DisjointSets unite_faces(const EdgeTable& edges, size_t face_count) {
    DisjointSets faces(face_count);
    for (size_t e = 0; e < edges.size(); ++e) {
        const auto around = edges.around(e);
        for (const uint32_t h : around) faces.unite(face_of(around[0]), face_of(h));
    }
    return faces;
}

Components number_components(const EdgeTable& edges, size_t face_count) {
    DisjointSets faces = unite_faces(edges, face_count);
    Components result{std::vector<uint32_t>(face_count), 0};
    for (uint32_t f = 0; f < face_count; ++f) {
        const uint32_t root = faces.find(f);
        result.of_face[f] = root == f ? result.count++ : result.of_face[root];
    }
    return result;
}

// Joins corners (3*f+i) into fans. Two corners of a vertex are in one fan if a walk from face to face, through edges of
// the vertex, leads from one to the other.
DisjointSets unite_fans(const EdgeTable& edges, std::span<const Triangle> triangles) {
    DisjointSets corners(3 * triangles.size());
    for (size_t e = 0; e < edges.size(); ++e) {
        const auto around = edges.around(e);
        const uint32_t h = around[0];
        for (const uint32_t g : around.subspan(1)) {
            const bool same_way = start_of(triangles, h) == start_of(triangles, g);
            corners.unite(h, same_way ? g : next(g));
            corners.unite(next(h), same_way ? next(g) : g);
        }
    }
    return corners;
}

// Every fan with a rim has two boundary edges, so chains of fans that share boundary edges are the loops.
uint64_t count_boundary_loops(const EdgeTable& edges, DisjointSets& fans, size_t corner_count) {
    DisjointSets chains(corner_count);
    std::vector<bool> on_rim(corner_count, false);
    for (size_t e = 0; e < edges.size(); ++e) {
        const auto around = edges.around(e);
        if (around.size() != 1) continue;
        const uint32_t a = fans.find(around[0]), b = fans.find(next(around[0]));
        on_rim[a] = on_rim[b] = true;
        chains.unite(a, b);
    }
    uint64_t loops = 0;
    for (uint32_t c = 0; c < corner_count; ++c) loops += on_rim[c] && chains.find(c) == c ? 1 : 0;
    return loops;
}

}  // namespace

EdgeTable build_edge_table(std::span<const Triangle> triangles, size_t vertex_count) {
    // Counting sort by the smaller vertex. Then the few half-edges of each vertex are sorted by the larger one.
    const auto half_edge_count = static_cast<uint32_t>(3 * triangles.size());
    std::vector<uint32_t> bucket(vertex_count + 1, 0);
    for (uint32_t h = 0; h < half_edge_count; ++h) {
        const uint32_t a = start_of(triangles, h), b = end_of(triangles, h);
        if (a != b) ++bucket[std::min(a, b) + 1];
    }
    for (size_t v = 0; v < vertex_count; ++v) bucket[v + 1] += bucket[v];

    struct Entry {
        uint32_t larger, half_edge;
        bool operator<(const Entry& other) const {
            return larger != other.larger ? larger < other.larger : half_edge < other.half_edge;
        }
    };
    std::vector<Entry> entries(bucket[vertex_count]);
    std::vector<uint32_t> fill(bucket.begin(), bucket.end() - 1);
    for (uint32_t h = 0; h < half_edge_count; ++h) {
        const uint32_t a = start_of(triangles, h), b = end_of(triangles, h);
        if (a != b) entries[fill[std::min(a, b)]++] = {std::max(a, b), h};
    }
    EdgeTable table;
    table.half_edges.reserve(entries.size());
    table.first.reserve(entries.size() / 2 + 2);
    for (size_t v = 0; v < vertex_count; ++v) {
        std::sort(entries.begin() + bucket[v], entries.begin() + bucket[v + 1]);
        for (uint32_t k = bucket[v]; k < bucket[v + 1]; ++k) {
            if (k == bucket[v] || entries[k].larger != entries[k - 1].larger) {
                table.first.push_back(static_cast<uint32_t>(table.half_edges.size()));
            }
            table.half_edges.push_back(entries[k].half_edge);
        }
    }
    table.first.push_back(static_cast<uint32_t>(table.half_edges.size()));
    return table;
}

TopologyAnalysis analyse_topology(std::span<const Triangle> triangles, size_t vertex_count) {
    TopologyAnalysis result;
    result.edges = build_edge_table(triangles, vertex_count);
    const EdgeTable& edges = result.edges;
    TopologySummary& summary = result.summary;
    summary.triangles = triangles.size();
    summary.edges = edges.size();

    for (uint32_t e = 0; e < edges.size(); ++e) {
        const auto around = edges.around(e);
        if (around.size() == 1) ++summary.boundary_edges;
        if (around.size() > 2) result.nonmanifold_edges.push_back(e);
        if (around.size() == 2 && start_of(triangles, around[0]) == start_of(triangles, around[1])) {
            result.misoriented_edges.push_back(e);
        }
    }
    Components components = number_components(edges, triangles.size());
    result.component_of_face = std::move(components.of_face);
    summary.components = components.count;

    DisjointSets fans = unite_fans(edges, triangles);
    std::vector<uint32_t> fans_at(vertex_count, 0);
    for (uint32_t c = 0; c < 3 * triangles.size(); ++c) fans_at[start_of(triangles, c)] += fans.find(c) == c ? 1u : 0u;
    for (uint32_t v = 0; v < vertex_count; ++v) {
        if (fans_at[v] > 0) ++summary.vertices;
        if (fans_at[v] > 1) result.nonmanifold_vertices.push_back(v);
    }
    summary.boundary_loops = count_boundary_loops(edges, fans, 3 * triangles.size());
    summary.nonmanifold_edges = result.nonmanifold_edges.size();
    summary.nonmanifold_vertices = result.nonmanifold_vertices.size();
    summary.misoriented_edges = result.misoriented_edges.size();
    summary.euler = static_cast<int64_t>(summary.vertices) - static_cast<int64_t>(summary.edges) +
                    static_cast<int64_t>(summary.triangles);

    const bool has_degenerate = edges.half_edges.size() != 3 * triangles.size();
    summary.manifold = !has_degenerate && result.nonmanifold_edges.empty() && result.nonmanifold_vertices.empty() &&
                       result.misoriented_edges.empty();
    summary.watertight = summary.manifold && summary.boundary_edges == 0 && summary.triangles > 0;
    summary.genus = summary.manifold
                        ? 0.5 * static_cast<double>(2 * static_cast<int64_t>(summary.components) - summary.euler -
                                                    static_cast<int64_t>(summary.boundary_loops))
                        : std::numeric_limits<double>::quiet_NaN();
    return result;
}

// Counts triangles that name missing vertices, but does not look at them. They make the mesh non-manifold.
TopologySummary summarize_topology(const TriangleMesh& mesh) {
    std::vector<Triangle> usable;
    usable.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
        if (*std::max_element(t.begin(), t.end()) < mesh.positions.size()) usable.push_back(t);
    }
    TopologySummary summary = analyse_topology(usable, mesh.positions.size()).summary;
    if (usable.size() != mesh.triangles.size()) {
        summary.triangles = mesh.triangles.size();
        summary.manifold = summary.watertight = false;
        summary.genus = std::numeric_limits<double>::quiet_NaN();
    }
    return summary;
}

Components connected_components(std::span<const Triangle> triangles, size_t vertex_count) {
    return number_components(build_edge_table(triangles, vertex_count), triangles.size());
}

std::vector<Mesh> split_components(const Mesh& mesh, const Components& components) {
    std::vector<Mesh> pieces(components.count);
    for (size_t f = 0; f < mesh.triangles.size(); ++f)
        pieces[components.of_face[f]].triangles.push_back(mesh.triangles[f]);
    std::vector<uint32_t> new_index(mesh.positions.size());
    for (Mesh& piece : pieces) {
        std::vector<uint32_t> vertices;
        for (const Triangle& t : piece.triangles) vertices.insert(vertices.end(), t.begin(), t.end());
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        for (const uint32_t v : vertices) {
            new_index[v] = static_cast<uint32_t>(piece.positions.size());
            piece.positions.push_back(mesh.positions[v]);
        }
        for (Triangle& t : piece.triangles) {
            for (uint32_t& v : t) v = new_index[v];
        }
    }
    return pieces;
}

}  // namespace gim

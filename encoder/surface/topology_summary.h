// Describes the connectivity of a triangle list, and where it is broken. Takes any triangles, manifold or not.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Half-edges grouped by the undirected edge they run along. Half-edge 3*f+i runs from corner i to corner i+1 of face f;
// half-edges from a vertex to itself are left out.
struct EdgeTable {
    std::vector<uint32_t> half_edges;  // group after group, ascending inside a group
    std::vector<uint32_t> first;       // edge e owns half_edges[first[e]] .. half_edges[first[e+1]-1]

    size_t size() const { return first.size() - 1; }
    std::span<const uint32_t> around(size_t e) const { return {half_edges.data() + first[e], first[e + 1] - first[e]}; }
};

// In: indices below vertex_count. O(F).
EdgeTable build_edge_table(std::span<const Triangle> triangles, size_t vertex_count);

struct TopologyAnalysis {
    TopologySummary summary;
    EdgeTable edges;
    std::vector<uint32_t> nonmanifold_edges;     // edges of more than two faces
    std::vector<uint32_t> misoriented_edges;     // edges of two faces that run the same way
    std::vector<uint32_t> nonmanifold_vertices;  // vertices whose faces form more than one fan
    std::vector<uint32_t> component_of_face;     // numbered by their first face
};

// In: indices below vertex_count. Nearly O(F).
TopologyAnalysis analyse_topology(std::span<const Triangle> triangles, size_t vertex_count);

// The pieces that are connected through edges, numbered in the order of their first faces.
struct Components {
    std::vector<uint32_t> of_face;
    uint32_t count = 0;
};
Components connected_components(std::span<const Triangle> triangles, size_t vertex_count);

// Returns each component as a mesh of its own. Vertices and faces keep their order. O(F log F).
std::vector<Mesh> split_components(const Mesh& mesh, const Components& components);

}  // namespace gim

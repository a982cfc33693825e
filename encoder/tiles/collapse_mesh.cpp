#include "encoder/tiles/collapse_mesh.h"

namespace gim {

// OpenMesh's own add_face() searches for its neighbours and prints where it finds none. The twins are known here.
CollapseMesh::CollapseMesh(const Mesh& mesh, const std::vector<bool>& sharp) : places_(mesh.positions) {
    const Topology topology = build_topology(mesh);
    const auto faces = static_cast<uint32_t>(mesh.triangles.size());
    reserve(mesh.positions.size(), 3 * faces / 2 + 1, faces);
    for (const Vec3& p : mesh.positions) add_vertex({p[0], p[1], p[2]});
    add_edges(mesh, topology, sharp);
    for (uint32_t f = 0; f < faces; ++f) {
        const FaceHandle face = new_face();
        set_halfedge_handle(face, handles_[3 * f]);
        for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
            set_next_halfedge_handle(handles_[h], handles_[next(h)]);
            set_face_handle(handles_[h], face);
            set_halfedge_handle(from_vertex_handle(handles_[h]), handles_[h]);
        }
    }
    link_boundaries(mesh, topology);
    handles_ = {};
    features_.resize(n_vertices());
    edges_.resize(n_vertices());
    for (const VertexHandle v : vertices()) count_around(v);
}

void CollapseMesh::add_edges(const Mesh& mesh, const Topology& topology, const std::vector<bool>& sharp) {
    handles_.resize(topology.twin.size());
    for (uint32_t h = 0; h < handles_.size(); ++h) {
        const uint32_t t = topology.twin[h];
        if (t < h) continue;
        handles_[h] = new_edge(vertex_handle(from(mesh, h)), vertex_handle(to(mesh, h)));
        if (t != kNone) handles_[t] = opposite_halfedge_handle(handles_[h]);
        crease_.push_back(t != kNone && !sharp.empty() && (sharp[h] || sharp[t]));
    }
}

// A boundary half-edge runs against the one inside. A boundary vertex hands out the boundary half-edge that leaves it.
void CollapseMesh::link_boundaries(const Mesh& mesh, const Topology& topology) {
    for (uint32_t h = 0; h < handles_.size(); ++h) {
        if (topology.twin[h] != kNone) continue;
        const HalfedgeHandle outside = opposite_halfedge_handle(handles_[h]);
        set_halfedge_handle(vertex_handle(to(mesh, h)), outside);
    }
    for (uint32_t h = 0; h < handles_.size(); ++h) {
        if (topology.twin[h] != kNone) continue;
        const HalfedgeHandle outside = opposite_halfedge_handle(handles_[h]);
        set_next_halfedge_handle(outside, halfedge_handle(vertex_handle(from(mesh, h))));
    }
}

void CollapseMesh::count_around(VertexHandle v) {
    uint32_t features = 0, edges = 0;
    for (auto h = cvoh_begin(v); h.is_valid(); ++h, ++edges) features += is_feature(edge_handle(*h));
    features_[static_cast<size_t>(v.idx())] = features;
    edges_[static_cast<size_t>(v.idx())] = edges;
}

void CollapseMesh::outgoing(VertexHandle v, std::vector<HalfedgeHandle>& spokes) const {
    spokes.clear();
    HalfedgeHandle first = halfedge_handle(v);
    if (is_boundary(first)) first = opposite_halfedge_handle(prev_halfedge_handle(first));
    HalfedgeHandle h = first;
    do {
        spokes.push_back(h);
        if (is_boundary(h)) return;
        h = opposite_halfedge_handle(prev_halfedge_handle(h));
    } while (h != first);
}

void CollapseMesh::drop_crease(EdgeHandle e) {
    crease_[static_cast<size_t>(e.idx())] = 0;
    count_around(to_vertex_handle(halfedge_handle(e, 0)));
    count_around(to_vertex_handle(halfedge_handle(e, 1)));
}

void CollapseMesh::collapse_keeping_creases(HalfedgeHandle h) {
    const VertexHandle vertex = from_vertex_handle(h), into = to_vertex_handle(h);
    const std::array<VertexHandle, 2> corners{opposite_corner(h), opposite_corner(opposite_halfedge_handle(h))};
    std::array<bool, 2> merged{};
    for (size_t side = 0; side < 2; ++side) {
        merged[side] = corners[side].is_valid() &&
                       (is_crease(edge_between(vertex, corners[side])) || is_crease(edge_between(into, corners[side])));
    }
    collapse(h);
    for (size_t side = 0; side < 2; ++side) {
        if (!corners[side].is_valid()) continue;
        // An ear leaves a boundary behind, and a boundary is no crease.
        const EdgeHandle e = edge_between(into, corners[side]);
        crease_[static_cast<size_t>(e.idx())] = merged[side] && !is_boundary(e);
        count_around(corners[side]);
    }
    count_around(into);
}

}  // namespace gim

// A triangle mesh that half-edge collapses coarsen: OpenMesh's half-edges, and which of its edges are features.
#pragma once

#include <OpenMesh/Core/Geometry/VectorT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <array>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

struct CollapseTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
    VertexAttributes(OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge);
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status);
};

// Vertices and faces have the numbers of the mesh that it was made from. A feature is a crease or a boundary.
class CollapseMesh : public OpenMesh::TriMesh_ArrayKernelT<CollapseTraits> {
  public:
    // In: an oriented 2-manifold; per half-edge 3f+i whether it lies on a crease (empty: no creases). O(F log F).
    CollapseMesh(const Mesh& mesh, const std::vector<bool>& sharp);

    // The kernel's own point() looks its property up each time.
    const Vec3& place(VertexHandle v) const { return places_[static_cast<size_t>(v.idx())]; }
    bool is_crease(EdgeHandle e) const { return crease_[static_cast<size_t>(e.idx())] != 0; }
    bool is_feature(EdgeHandle e) const { return is_crease(e) || is_boundary(e); }
    // Numbers of features and of edges that end at v.
    uint32_t feature_count(VertexHandle v) const { return features_[static_cast<size_t>(v.idx())]; }
    uint32_t edge_count(VertexHandle v) const { return edges_[static_cast<size_t>(v.idx())]; }
    // The edge from v to w, which are neighbours.
    EdgeHandle edge_between(VertexHandle v, VertexHandle w) const { return edge_handle(find_halfedge(v, w)); }
    // The corner opposite h in its face; invalid where h is a boundary.
    VertexHandle opposite_corner(HalfedgeHandle h) const {
        return is_boundary(h) ? VertexHandle() : to_vertex_handle(next_halfedge_handle(h));
    }
    // The half-edges that leave v, counter-clockwise. On a boundary vertex the first and the last run along the boundary.
    void outgoing(VertexHandle v, std::vector<HalfedgeHandle>& spokes) const;

    // Moves from_vertex_handle(h) onto to_vertex_handle(h); is_collapse_ok(h) must hold. Where two edges become one, it
    // is a crease if one of them was.
    void collapse_keeping_creases(HalfedgeHandle h);
    // Makes an edge smooth.
    void drop_crease(EdgeHandle e);

  private:
    void add_edges(const Mesh& mesh, const Topology& topology, const std::vector<bool>& sharp);
    void link_boundaries(const Mesh& mesh, const Topology& topology);
    void count_around(VertexHandle v);

    std::vector<HalfedgeHandle> handles_;     // per half-edge of the input, while it is built
    std::vector<Vec3> places_;                // per vertex
    std::vector<uint8_t> crease_;             // per edge
    std::vector<uint32_t> features_, edges_;  // per vertex
};

inline uint32_t index(OpenMesh::BaseHandle handle) { return static_cast<uint32_t>(handle.idx()); }

}  // namespace gim

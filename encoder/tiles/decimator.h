// Coarsens a mesh by half-edge collapses, the cheapest first, until nothing is left to collapse.
#pragma once

#include <queue>
#include <vector>

#include "encoder/tiles/base_mesh.h"
#include "encoder/tiles/collapse_cost.h"

namespace gim {

class Decimator {
  public:
    // In: an oriented 2-manifold; per half-edge 3f+i whether it is a crease (empty: none); per vertex what it stands for.
    // Seeds per vertex: see CollapseCost.
    Decimator(const Mesh& mesh, const std::vector<bool>& sharp, std::vector<VertexShare> shares,
              std::vector<uint32_t> seeds = {});
    Decimator(const Decimator&) = delete;
    Decimator& operator=(const Decimator&) = delete;

    // Collapses until at most `faces` are left, or nothing more can go. O(V log V).
    void run(uint32_t faces);
    // Makes one collapse, whatever it costs; it must keep a manifold.
    void collapse(OpenMesh::HalfedgeHandle h);
    void collapse(uint32_t vertex, uint32_t into);
    // What a collapse costs that keeps all creases; nothing if it is forbidden.
    std::optional<double> cost_of(OpenMesh::HalfedgeHandle h);

    const std::vector<HalfEdgeCollapse>& collapses() const { return collapses_; }
    // Per face: how many collapses were made before the one that removed it; kNone if it is there.
    const std::vector<uint32_t>& removed_by() const { return removed_by_; }
    const CollapseMesh& mesh() const { return mesh_; }
    uint32_t face_count() const { return faces_; }
    // What all collapses did to the surface; see CollapseCost.
    double damage() const { return damage_; }
    // Number of collapses that were made by these rules or stricter ones.
    uint32_t made_by(Rules rules) const { return made_by_[static_cast<size_t>(rules)]; }

  private:
    struct Entry {
        double cost;
        uint32_t vertex, version;
        // Smallest cost first; ties by vertex, so that the order is the same everywhere.
        bool operator<(const Entry& o) const { return cost != o.cost ? cost > o.cost : vertex > o.vertex; }
    };
    void find_floors();
    bool above_floor(OpenMesh::HalfedgeHandle h) const;
    void run_by(Rules rules, uint32_t faces);
    void push(OpenMesh::VertexHandle v, Rules rules);
    void push_around(OpenMesh::VertexHandle v, Rules rules);
    void drop_creases(OpenMesh::HalfedgeHandle h);

    CollapseMesh mesh_;
    std::vector<VertexShare> shares_;
    std::vector<uint32_t> seeds_;
    CollapseCost costs_;
    std::vector<uint32_t> version_;
    std::priority_queue<Entry> queue_;
    std::vector<HalfEdgeCollapse> collapses_;
    std::vector<uint32_t> removed_by_;
    std::array<uint32_t, 3> made_by_{};
    uint32_t faces_;
    double damage_ = 0;
    // Per vertex its component; per component its faces, and how few it may have.
    std::vector<uint32_t> component_, component_faces_, floor_;
};

}  // namespace gim

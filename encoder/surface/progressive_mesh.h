// Coarsens a mesh by half-edge collapses, and refines it again by undoing them in reverse order.
//
// After: Hoppe. Progressive Meshes. SIGGRAPH 1996. Our collapses are half-edge collapses, so every coarse vertex is an
// input vertex. Two stages use this: augment_cut.h searches for a good cut on a coarse version of the surface, and
// parametrize.h optimises stretch from coarse to fine (Sander, Gortler, Snyder, Hoppe 2002). Only interior vertices are
// removed; boundaries stay.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// A collapse that was undone: `vertex` came back, split off from `into`. Two faces came back with it, at half-edge
// `edge` (vertex -> into) and at its twin. `left` and `right` are their third corners.
struct VertexSplit {
    uint32_t vertex, into, left, right;
    uint32_t edge;
};

class ProgressiveMesh {
  public:
    // In: an oriented 2-manifold. O(F log F).
    explicit ProgressiveMesh(const Mesh& mesh);

    // Half-edges keep their numbers; those of removed faces are dead (see alive()).
    uint32_t origin(uint32_t h) const { return origin_[h]; }
    uint32_t target(uint32_t h) const { return origin_[next(h)]; }
    uint32_t twin(uint32_t h) const { return twin_[h]; }
    // Returns a half-edge that leaves v, or kNone if v is removed. On a boundary vertex, walking twin(prev(h)) from it
    // meets every face.
    uint32_t outgoing(uint32_t v) const { return outgoing_[v]; }
    bool alive(uint32_t face) const { return alive_[face] != 0; }
    bool removed(uint32_t v) const { return outgoing_[v] == kNone; }
    bool on_boundary(uint32_t v) const { return outgoing_[v] != kNone && twin_[outgoing_[v]] == kNone; }
    uint32_t vertex_count() const { return vertex_count_; }
    uint32_t original_vertex_count() const { return static_cast<uint32_t>(outgoing_.size()); }
    uint32_t half_edge_count() const { return static_cast<uint32_t>(origin_.size()); }
    size_t collapse_count() const { return collapses_.size(); }
    bool coarsened() const { return !collapses_.empty(); }

    // Asks holds(h) of the half-edges that leave v, counter-clockwise, until one says no. Returns whether none did.
    template <class Holds>
    bool all_outgoing(uint32_t v, Holds&& holds) const {
        const uint32_t first = outgoing_[v];
        uint32_t h = first;
        do {
            if (!holds(h)) return false;
            h = twin_[prev(h)];
        } while (h != first && h != kNone);
        return true;
    }

    // Calls visit(h) for every half-edge that leaves v, counter-clockwise.
    template <class Visit>
    void for_each_outgoing(uint32_t v, Visit&& visit) const {
        all_outgoing(v, [&](uint32_t h) {
            visit(h);
            return true;
        });
    }

    // Calls visit(w) for every neighbour vertex w. A boundary vertex has one more of them than outgoing half-edges.
    template <class Visit>
    void for_each_neighbour(uint32_t v, Visit&& visit) const {
        const uint32_t first = outgoing_[v];
        uint32_t h = first, last = first;
        do {
            visit(target(h));
            last = h;
            h = twin_[prev(h)];
        } while (h != first && h != kNone);
        if (h == kNone) visit(origin_[prev(last)]);
    }

    // Removes origin(h), an interior vertex, by moving it onto target(h). The caller must have checked can_collapse(h).
    void collapse(uint32_t h);
    // Returns whether the mesh is still a 2-manifold after collapsing h (link condition). O(valence^2).
    bool can_collapse(uint32_t h) const;
    // Undoes the last collapse.
    VertexSplit split();

    // The current mesh, compacted, and the original number of each of its vertices and faces.
    struct Compacted {
        Mesh mesh;
        std::vector<uint32_t> vertices, faces;
    };
    Compacted compact(const std::vector<Vec3>& positions) const;

  private:
    struct Collapse {
        uint32_t edge;  // vertex -> into
        uint32_t vertex, into;
        uint32_t outer[4];     // twins of next and prev of `edge`, then of next and prev of its twin
        uint32_t outgoing[4];  // of vertex, into, left and right, before the collapse
    };
    void pair(uint32_t a, uint32_t b);
    void repair_outgoing(uint32_t v, uint32_t candidate);

    std::vector<uint32_t> origin_, twin_, outgoing_;
    std::vector<uint8_t> alive_;
    std::vector<Collapse> collapses_;
    uint32_t vertex_count_ = 0;
};

struct SimplifyOptions {
    uint32_t target_vertices = 0;  // coarsening stops here; boundary vertices count
    // If well-shaped collapses run out above the target, continue with any that keep a manifold.
    bool insist = false;
    // Per vertex: bits of the sides of the square that it lies on. No new edge may join two vertices that share a side,
    // because it would be flat in the square. Empty: no such rule.
    std::vector<uint8_t> sides;
};

// Coarsens by quadric error (Garland, Heckbert 1997), plus a term that prefers short edges in flat regions. O(V log V).
void simplify(ProgressiveMesh& mesh, const std::vector<Vec3>& positions, const SimplifyOptions& options);

}  // namespace gim

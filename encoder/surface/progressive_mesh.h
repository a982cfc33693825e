// A mesh that is coarsened by half-edge collapses and refined again by undoing them in reverse order.
//
// After: Hoppe. Progressive Meshes. SIGGRAPH 1996, with half-edge collapses, so that every coarse vertex is an input
// vertex. Used twice: to look for a good cut on a coarse version of the surface (augment_cut.h), and coarse to fine by
// the stretch optimisation (parametrize.h; Sander, Gortler, Snyder, Hoppe 2002). Only interior vertices are ever
// removed: boundaries stay.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// One undo of a collapse: `vertex` came back, split off from `into`. `left` and `right` are the third corners of the
// two faces that came back with it, at half-edges `edge` (vertex -> into) and its twin.
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
    // A half-edge that leaves v; on a boundary vertex the one from which walking twin(prev(h)) meets every face. kNone
    // when removed.
    uint32_t outgoing(uint32_t v) const { return outgoing_[v]; }
    bool alive(uint32_t face) const { return alive_[face] != 0; }
    bool removed(uint32_t v) const { return outgoing_[v] == kNone; }
    bool on_boundary(uint32_t v) const { return outgoing_[v] != kNone && twin_[outgoing_[v]] == kNone; }
    uint32_t vertex_count() const { return vertex_count_; }
    uint32_t original_vertex_count() const { return static_cast<uint32_t>(outgoing_.size()); }
    uint32_t half_edge_count() const { return static_cast<uint32_t>(origin_.size()); }
    size_t collapse_count() const { return collapses_.size(); }
    bool coarsened() const { return !collapses_.empty(); }

    // Calls visit(h) for every half-edge that leaves v, counter-clockwise.
    template <class Visit>
    void for_each_outgoing(uint32_t v, Visit&& visit) const {
        const uint32_t first = outgoing_[v];
        uint32_t h = first;
        do {
            visit(h);
            h = twin_[prev(h)];
        } while (h != first && h != kNone);
    }

    // The same for every neighbour vertex (on a boundary that is one more than half-edges).
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

    // Removes origin(h), an interior vertex, by moving it onto target(h). The caller has checked can_collapse(h).
    void collapse(uint32_t h);
    // Whether collapsing h keeps a 2-manifold (link condition). O(valence^2).
    bool can_collapse(uint32_t h) const;
    // Undoes the last collapse.
    VertexSplit split();

    // The current mesh, compacted, with the original number of each of its vertices and faces.
    struct Compacted {
        Mesh mesh;
        std::vector<uint32_t> vertices, faces;
    };
    Compacted compact(const std::vector<Vec3>& positions) const;

  private:
    struct Collapse {
        uint32_t edge;  // vertex -> into
        uint32_t vertex, into;
        uint32_t outer[4];     // twins of next/prev of edge, next/prev of its twin
        uint32_t outgoing[4];  // of vertex, into, left, right before the collapse
    };
    void pair(uint32_t a, uint32_t b);
    void repair_outgoing(uint32_t v, uint32_t candidate);

    std::vector<uint32_t> origin_, twin_, outgoing_;
    std::vector<uint8_t> alive_;
    std::vector<Collapse> collapses_;
    uint32_t vertex_count_ = 0;
};

struct SimplifyOptions {
    uint32_t target_vertices = 0;  // stop here, boundary vertices included
    bool insist = false;  // when well-shaped collapses run out above the target, go on with any that keep a manifold
    // Per vertex: bits of the sides of the square that it lies on. No edge is made between two vertices that share a
    // side (it would be flat in the square). Empty: no such rule.
    std::vector<uint8_t> sides;
};

// Coarsens by quadric error (Garland, Heckbert 1997) with a term that prefers short edges in flat regions. O(V log V).
void simplify(ProgressiveMesh& mesh, const std::vector<Vec3>& positions, const SimplifyOptions& options);

}  // namespace gim

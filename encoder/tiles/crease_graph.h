// Follows the creases of a mesh through half-edge collapses, and back.
#pragma once

#include <array>
#include <vector>

#include "encoder/surface/mesh.h"
#include "encoder/tiles/base_mesh.h"

namespace gim {

class CreaseGraph {
  public:
    // In: an oriented 2-manifold; per half-edge whether it lies on a crease (empty: none).
    CreaseGraph(const Mesh& mesh, const std::vector<bool>& sharp);

    // Moves a crease along with its vertex. A corner that moves, or a vertex that leaves its crease, ends its creases.
    void collapse(const HalfEdgeCollapse& collapse);
    // Undoes all collapses. Creases that ended stay ended, back to their last dense edge.
    void undo_all();

    // The edges that lie on creases, smaller vertex first, ascending.
    std::vector<std::array<uint32_t, 2>> edges() const;
    // Per vertex of the mesh, of the creases as they are and of its boundaries.
    std::vector<VertexKind> kinds() const;

  private:
    // vertex lay on the crease from into to other; kNone if it lay on none that went on.
    struct Step {
        uint32_t vertex, into, other;
    };
    bool joined(uint32_t a, uint32_t b) const;
    void join(uint32_t a, uint32_t b);
    void part(uint32_t a, uint32_t b);

    std::vector<std::vector<uint32_t>> neighbours_;  // along creases
    std::vector<bool> boundary_;
    std::vector<Step> steps_;
};

}  // namespace gim

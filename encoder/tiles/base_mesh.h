// Simplifies a dense mesh to a coarse one whose vertices are input vertices: the base of the tiles.
//
// After: Maximo, Velho, Siqueira. Adaptive multi-chart and multiresolution mesh representation. 2013 (4.1). We differ:
// a half-edge collapse composes their flips and welds, and only creases and boundaries are more than the quadric error.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// `vertex` moved onto `into`, and two faces vanished (on a boundary one). left and right are their third corners, left
// and right of the way from vertex to into; kNone where a boundary is.
struct HalfEdgeCollapse {
    uint32_t vertex, into, left, right;
};

// Features are creases and boundaries.
enum class VertexKind : uint8_t {
    kSmooth,  // lies on none
    kCrease,  // two of them meet here: a crease or a boundary passes through
    kCorner,  // more or fewer meet here, or a crease meets a boundary
};

struct BaseMesh {
    std::vector<Triangle> triangles;               // of input vertices, counter-clockwise
    std::vector<HalfEdgeCollapse> collapses;       // in the order in which they were made
    std::vector<std::array<uint32_t, 2>> creases;  // edges of the base that lie on creases, ascending
    std::vector<VertexKind> kinds;                 // per input vertex. A crease that the base gave up is smooth.
};

// Returns per half-edge 3f+i whether its faces meet at a dihedral angle of `angle` or more (radians; 0 is flat).
std::vector<bool> find_creases(const Mesh& mesh, double angle);

// Every base from the input down to the smallest one, as one list of collapses. A base of any size is a prefix of it.
class BaseHierarchy {
  public:
    // In: an oriented 2-manifold of any genus, boundaries and number of components; per half-edge 3f+i whether it lies on
    //     a crease (empty: none do; one half-edge of two is enough).
    // Cost: O(F log F), about 20 us a face.
    BaseHierarchy(const Mesh& mesh, const std::vector<bool>& sharp);

    const std::vector<HalfEdgeCollapse>& collapses() const { return collapses_; }
    // Per input face: how many collapses precede the one that removes it; kNone if none does.
    const std::vector<uint32_t>& removed_by() const { return removed_by_; }
    // Number of collapses until at most so many faces are left: all of them if the smallest base has more.
    uint32_t collapses_down_to(uint32_t faces) const;
    // The base after the first `count` collapses. O(F).
    BaseMesh cut(const Mesh& mesh, uint32_t count) const;
    // Number of collapses that broke no rule of shape, or none but those.
    uint32_t well_shaped() const { return well_shaped_; }
    uint32_t with_all_creases() const { return with_all_creases_; }

  private:
    std::vector<HalfEdgeCollapse> collapses_;
    std::vector<uint32_t> removed_by_;
    std::vector<bool> sharp_;
    uint32_t well_shaped_ = 0, with_all_creases_ = 0;
};

// The base of a given list of collapses. removed_by: per face, how many collapses precede the one that removes it.
BaseMesh base_after(const Mesh& mesh, const std::vector<bool>& sharp, std::vector<HalfEdgeCollapse> collapses,
                    const std::vector<uint32_t>& removed_by);

}  // namespace gim

// Says which half-edge collapses of a mesh are allowed, and what each costs.
//
// After: Garland, Heckbert. Surface Simplification Using Quadric Error Metrics. SIGGRAPH 1997. Features add planes across
// their faces. We differ: the cost also grows with the area that moves and how far, with needles, with irregular
// valences, and with the angle of the fan of faces that v leaves behind at u. The map that undoes the collapses needs
// narrow fans.
#pragma once

#include <optional>
#include <vector>

#include "encoder/surface/quadric.h"
#include "encoder/tiles/collapse_mesh.h"

namespace gim {

// What a vertex stands for: itself and those that moved onto it.
struct VertexShare {
    Quadric planes;
    double area = 0;

    VertexShare& operator+=(const VertexShare& o) {
        planes += o.planes;
        area += o.area;
        return *this;
    }
};

// One share for each vertex of the mesh. O(F).
std::vector<VertexShare> vertex_shares(const Mesh& mesh, const std::vector<bool>& sharp);

// Rules that may be given up, one after the other, where nothing else is left to collapse. Topology always stays.
enum class Rules : uint8_t {
    kAll,
    kLooseShape,  // faces may turn farther, fans may be wider, loose ends of creases may shrink
    kTopology,    // creases and corners may vanish
};

class CollapseCost {
  public:
    // All must outlive this. Where the seed of a vertex is not 0, its costs vary by a factor that depends on it, so that
    // another base comes out. No seeds: none vary.
    CollapseCost(CollapseMesh& mesh, const std::vector<VertexShare>& shares, const std::vector<uint32_t>& seeds)
        : mesh_(mesh), shares_(shares), seeds_(seeds) {}

    struct Candidate {
        double cost = 0;
        OpenMesh::HalfedgeHandle edge;  // invalid if v cannot move
    };
    // Returns the cheapest collapse of v onto a neighbour. O(valence^2).
    Candidate best(OpenMesh::VertexHandle v, Rules rules);

    // What one collapse costs; nothing if it is forbidden. O(valence).
    std::optional<double> cost_of(OpenMesh::HalfedgeHandle h, Rules rules);

    // How far the surface moves, as area times squared distance: a part of the cost.
    double damage(OpenMesh::HalfedgeHandle h);

  private:
    struct Spoke {
        OpenMesh::HalfedgeHandle edge;
        OpenMesh::VertexHandle end;
        Vec3 at;
        bool feature, rim_feature;  // of the spoke, and of the rim edge to the next spoke
        Vec3 normal;                // of the face to the next spoke, as long as twice its area
    };
    void gather(OpenMesh::VertexHandle v);
    size_t face_count() const { return closed_ ? spokes_.size() : spokes_.size() - 1; }
    size_t after(size_t spoke) const { return spoke + 1 == spokes_.size() ? 0 : spoke + 1; }
    // Whether the face to the next spoke vanishes with spoke `onto`.
    bool vanishes(size_t face, size_t onto) const { return face == onto || after(face) == onto; }
    bool joins(size_t a, size_t b) const;

    bool features_allow(size_t onto, Rules rules) const;
    bool feature_after(size_t spoke, size_t onto) const;
    bool crowds(size_t onto) const;
    bool boundary_stays_long(size_t onto) const;
    // How much the shape of the new faces multiplies the cost; nothing if they are forbidden.
    std::optional<double> shape_factor(size_t onto, Rules rules) const;
    double squared_gap(size_t onto) const;
    double variation(size_t onto) const;
    double valence_factor(size_t onto) const;
    // Whether the collapse leaves faces that cannot be paired without a vertex of two quads.
    bool makes_doublet(size_t onto);
    struct Fan {
        double angle;  // at the kept vertex, in radians
        size_t faces;
    };
    Fan fan(size_t onto) const;
    // Nothing if it is forbidden, or costs no less than `limit`.
    std::optional<double> cost(size_t onto, Rules rules, double limit);

    CollapseMesh& mesh_;  // its own check marks vertices, and leaves no other trace
    const std::vector<VertexShare>& shares_;
    const std::vector<uint32_t>& seeds_;
    OpenMesh::VertexHandle centre_;
    std::vector<OpenMesh::HalfedgeHandle> outgoing_;
    std::vector<Spoke> spokes_;
    std::vector<OpenMesh::HalfedgeHandle> ring_;
    bool closed_ = true;
};

}  // namespace gim

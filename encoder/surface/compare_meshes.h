// Many surfaces against one reference: what compare() does, with the reference's search tree built once.
#pragma once

#include "encoder/surface/closest_point.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

class ReferenceSurface {
  public:
    // Keeps the mesh. In: finite positions, indices in range.
    explicit ReferenceSurface(Mesh mesh, uint32_t threads = 0);

    // As compare(), for a test mesh with finite positions and indices in range.
    Result<Comparison> compare(const Mesh& test, const CompareOptions& options) const;
    const Mesh& mesh() const { return mesh_; }

  private:
    Mesh mesh_;
    ClosestPointTree tree_;
    double diagonal_;
};

}  // namespace gim

// Compares many surfaces with one reference. Does what compare() does, but builds the reference's search tree once.
#pragma once

#include "encoder/surface/closest_point.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Returns the diagonal of the bounding box of the vertices that triangles use.
double bounding_diagonal(const Mesh& mesh);

class ReferenceSurface {
  public:
    // Keeps the mesh. Its positions must be finite and its indices in range.
    explicit ReferenceSurface(Mesh mesh, uint32_t threads = 0);

    // Does what compare() does. The positions of `test` must be finite and its indices in range.
    Result<Comparison> compare(const Mesh& test, const CompareOptions& options) const;
    const Mesh& mesh() const { return mesh_; }
    double diagonal() const { return diagonal_; }

  private:
    Mesh mesh_;
    ClosestPointTree tree_;
    double diagonal_;
};

}  // namespace gim

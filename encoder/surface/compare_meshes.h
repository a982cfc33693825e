// Compares many surfaces with one reference. Does what compare() does, but prepares the reference once.
#pragma once

#include <memory>

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
    ReferenceSurface(const ReferenceSurface&) = delete;
    ReferenceSurface& operator=(const ReferenceSurface&) = delete;
    ~ReferenceSurface();

    // Does what compare() does. The positions of `test` must be finite and its indices in range. Several threads may call it at
    // once.
    Result<Comparison> compare(const Mesh& test, const CompareOptions& options) const;
    const Mesh& mesh() const { return mesh_; }
    double diagonal() const { return diagonal_; }

  private:
    class Traits;

    Mesh mesh_;
    ClosestPointTree tree_;
    double diagonal_;
    std::unique_ptr<Traits> traits_;  // found when they are first asked for
};

}  // namespace gim

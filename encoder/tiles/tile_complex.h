// A quad complex (format/quad_complex.h) that owns its arrays.
#pragma once

#include <vector>

#include "encoder/base/result.h"
#include "format/quad_complex.h"

namespace gim {

class TileComplex {
  public:
    // In: quads of any vertices, which make an oriented 2-manifold. Fails if they do not. O(n log n).
    static Result<TileComplex> make(const std::vector<Quad>& quads);

    const std::vector<uint32_t>& mates() const { return mates_; }
    // A view of the arrays, valid as long as this lives where it is.
    QuadComplex view();
    // Per vertex of the complex: the vertex that the quads name.
    const std::vector<uint32_t>& vertices() const { return vertices_; }

  private:
    std::vector<uint32_t> mates_, vertex_, edge_, lower_, valence_, vertices_;
    std::vector<uint8_t> on_boundary_;
    uint32_t edge_count_ = 0;
};

}  // namespace gim

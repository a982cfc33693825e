// A surface with details: the samples of an image, finer ones between them, and what displaces these.
// Maximo, Velho, Siqueira. Adaptive Multi-chart and Multiresolution Mesh Representation. 2013, section 5 (figure 10).
// spec/gim-format.md, "Displacements". The paper's extra charts are one plane here: zeros outside of an edit cost next to
// nothing, and a plane already has one value on each edge.
#pragma once

#include <cstdint>

#include "decoder/refine/quad_domain.h"

namespace gim {

// A decoded plane: rows of `width` triples, 2^finer of them for each step between samples.
struct DisplacementImage {
    const float* values = nullptr;
    uint32_t width = 0, finer = 0;
};

// Writes the position of each vertex of `fine`: that of `coarse`, linear in row and column between its samples, plus the
// displacement. `fine` has 2^finer intervals for each one of `coarse`. positions: per vertex of `coarse`, a triple.
// Cost: O(vertices of fine).
void displace(const QuadDomain& coarse, const QuadDomain& fine, const DisplacementImage& image, const float* positions,
              float* detailed);

}  // namespace gim

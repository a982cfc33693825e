// Closes the cut of a decoded image: averages every class of glued samples and spreads the correction inwards.
// After: Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 4, "Compression and Decompression". The paper
// leaves the diffusion open; ours is a linear ramp over side/16 rings.  spec/gim-format.md, "Fusing".
#pragma once

#include <cstdint>

#include "format/close_seams.h"

namespace gim {

// Work space of fuse.
struct FuseWork : PointWork {
    float* outer = nullptr;  // corrections of one ring, 3 per ring sample
    float* inner = nullptr;  // corrections of the next ring
};

// Only averages each class. Leaves the corrections in work.outer. Returns false if no sample changes. Cost O(side).
bool average_classes(uint32_t side, const uint32_t* class_of, uint32_t class_count, float* samples,
                     const FuseWork& work);

// Averages and spreads. samples: side*side triples. class_of: per ring sample (ring_classes). Changes nothing if glued
// samples are equal already. Cost O(side^2 / 4).
void fuse(uint32_t side, const uint32_t* class_of, uint32_t class_count, float* samples, const FuseWork& work);

// How many rings inside the rim get a part of the correction.
uint32_t diffusion_width(uint32_t side);

}  // namespace gim

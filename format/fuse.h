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
    float* inner = nullptr;  // and of the next
};

// Only the mean over each class. The corrections are left in work.outer. Returns false when no sample changes. Cost O(side).
bool average_classes(uint32_t side, const uint32_t* class_of, uint32_t class_count, float* samples,
                     const FuseWork& work);

// samples: side*side triples. class_of: per ring sample (ring_classes). Nothing changes where equals are equal already.
// Cost O(side^2 / 4).
void fuse(uint32_t side, const uint32_t* class_of, uint32_t class_count, float* samples, const FuseWork& work);

// How many rings below the rim get a part of the correction.
uint32_t diffusion_width(uint32_t side);

}  // namespace gim

// Every level of a file, decoded and measured against the input.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/surface/compare_meshes.h"
#include "gim/encoder.h"

namespace gim {

// In:  a file of ours, the input's surface, and how the full resolution compares to it (it is not measured again).
// Out: one entry per level that at least one image can close, finest first. Cost: one decoding and one comparison a level,
//      coarser levels with fewer samples.
Result<std::vector<LevelReport>> measure_levels(std::span<const uint8_t> bytes, const ReferenceSurface& reference,
                                                const Comparison& full, uint32_t threads);

}  // namespace gim

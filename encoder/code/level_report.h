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

// PSNR for each level of the file; 0 for those that no image can close.
std::vector<double> psnr_of_levels(std::span<const LevelReport> levels, uint32_t level_count);

// Sizes of a complete file. report: numbers of samples and input vertices are known.
void describe_file(std::span<const uint8_t> bytes, EncodeReport& report);

}  // namespace gim

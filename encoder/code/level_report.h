// Decodes every level of a file and measures it against the input.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/code/assemble_file.h"
#include "encoder/surface/compare_meshes.h"
#include "gim/encoder.h"

namespace gim {

// In:  our own file, the input's surface, and the comparison at full resolution, with its defects. That is not measured
//      again.
// Out: one entry per level at which the seams of at least one image close, finest first.
// Cost: one decoding and one comparison a level; coarser levels take fewer samples.
Result<std::vector<LevelReport>> measure_levels(std::span<const uint8_t> bytes, const ReferenceSurface& reference,
                                                const Comparison& full, uint32_t threads);

// Returns the error of each level of the file; not known where no image has closed seams at that level.
std::vector<LevelError> errors_of_levels(std::span<const LevelReport> levels, uint32_t level_count);

// Sets the sizes of a complete file in the report, which must have the numbers of samples and input vertices.
void describe_file(std::span<const uint8_t> bytes, EncodeReport& report);

}  // namespace gim

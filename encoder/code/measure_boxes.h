// Finds the boxes of a file's images, for its header.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/base/result.h"
#include "format/bounds.h"

namespace gim {

// In:  our own file.
// Out: for each image the smallest box that holds it at each of its levels, and with any of its displacements at any of
//      its points. Coordinates are as the decoder gives them.
// Cost: one decoding of each level.
Result<std::vector<Box>> measure_boxes(std::span<const uint8_t> bytes);

}  // namespace gim

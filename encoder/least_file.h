// The smallest file of a set of images.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/layout/layout_images.h"

namespace gim {

// True if the decoded surface has area. It has none where the quantizer is so coarse that all samples are one.
Result<bool> has_area(std::span<const uint8_t> bytes);

// Returns the smallest file found whose surface has area. A fact about the images, the parameters and `first`, the
// quantizer of a usual file: what was fitted before does not matter. The fit goes on from that of the result. Cost:
// about 8 files, each fitted if the images are.
Result<std::vector<uint8_t>> least_file(LayoutImages& images, CodingParameters parameters, double first,
                                        StageClock& clock);

}  // namespace gim

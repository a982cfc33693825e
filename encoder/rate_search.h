// From a rate target to the file that meets it.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/layout/layout_images.h"
#include "encoder/surface/compare_meshes.h"
#include "gim/encoder.h"

namespace gim {

// Codes the images at the quantizer that options.rate asks for:
//   lossless  the quantized images are kept exactly
//   quality   no search
//   psnr      the smallest file found whose surface is not below `value`; an Error names the best in reach
//   bytes     the best file found that is not above `value`; an Error names the smallest size in reach
// Images that are fitted to their quantizer are fitted again for each; the last fit stays. parameters: planes and text.
// Cost: up to about 16 files, each fitted, decoded and compared. The values of the search: code/rate_target.h.
Result<std::vector<uint8_t>> search_rate(LayoutImages& images, const CodingParameters& parameters,
                                         const EncodeOptions& options, const ReferenceSurface& reference,
                                         StageClock& clock);

}  // namespace gim

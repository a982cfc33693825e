// --layout auto for lossy files: layouts race at the target, and the best file wins.
#pragma once

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/layout_runs.h"
#include "gim/encoder.h"

namespace gim {

// Squares and tiles race; tiles only if no planes are wanted, which they cannot hold. Each layout makes its images and fits
// them briefly. The one that seems cheapest is coded in full. Another one is coded only if its brief fit leaves a chance,
// and ends as soon as it is sure to lose. At --quality the square comes first, and its PSNR is the target of the others.
// Charts run only if no other layout can make images: each has a border to store, and the wavelet cannot predict across
// it. Horse and feline at 80 dB take 13,598 and 29,172 bytes as charts, 5,979 and 22,894 as squares, 5,760 and 14,063 as
// tiles. Without loss, choose_layout.h may take them.
Result<Encoded> race_layouts(const Prepared& prepared, const EncodeOptions& options, StageClock& clock,
                             const Observer& observer);

}  // namespace gim

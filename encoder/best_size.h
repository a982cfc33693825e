// Chooses the size of the image, the side of a square or the samples of charts: codes several and keeps the best file.
#pragma once

#include <vector>

#include "encoder/layout/encode_once.h"
#include "gim/encoder.h"

namespace gim {

// The sizes that best_of_sizes() begins with, the half first.
std::vector<EncodeOptions> size_variants(const EncodeOptions& options);

// Codes the size that is asked for. If the options allow smaller sizes and the target is coarse, also tries the half, and
// goes on as long as halving makes the file better. Returns the best file. The half runs first: it is faster, it chooses
// the cuts of squares, and if a quarter is better still, charts are not coded in full size. A side of squares that is sure
// to lose ends early (contest.h).
Result<Encoded> best_of_sizes(const CodingRuns& runs, const EncodeOptions& options);

}  // namespace gim

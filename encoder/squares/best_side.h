// Chooses the side of the square: codes several and keeps the best file.
#pragma once

#include <vector>

#include "encoder/layout/encode_once.h"
#include "gim/encoder.h"

namespace gim {

// The sides that best_of_sides() begins with, the half first.
std::vector<EncodeOptions> side_variants(const EncodeOptions& options);

// Codes the side that is asked for. If the options allow smaller sides and the target is coarse, also tries half of the
// side, and goes on as long as halving makes the file better. Returns the best file. The half runs first, because it
// chooses the cuts in a quarter of the time. A side that is sure to lose ends early (contest.h).
Result<Encoded> best_of_sides(const CodingRuns& runs, const EncodeOptions& options);

}  // namespace gim

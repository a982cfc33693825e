// Chooses among sides of the square by what the files take.
#pragma once

#include <functional>

#include "encoder/base/stage_clock.h"
#include "gim/encoder.h"

namespace gim {

// Makes and codes images with these options.
using EncodeOnce = std::function<Result<Encoded>(const EncodeOptions& options, const Observer& observer)>;

// The file of the side that is asked for. Where options allow it and the target is coarse: also of half of it, and so on as long
// as halving makes it better. The half comes first: cuts are chosen there, in a quarter of the time. Pictures are those of
// the first. The times are those of all runs.
Result<Encoded> best_of_sides(const EncodeOnce& run, const EncodeOptions& options, const StageClock& clock,
                              const Observer& observer);

}  // namespace gim

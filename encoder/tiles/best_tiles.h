// Chooses the number of tiles: codes several and keeps the best file.
#pragma once

#include "encoder/base/stage_clock.h"
#include "encoder/layout/encode_once.h"

namespace gim {

// If the options leave the number open and the target is searched for, tries several. A number that is sure to lose ends
// early (contest.h). Returns the best file. Only the first run shows pictures. The times are those of all runs.
Result<Encoded> best_of_tiles(const EncodeOnce& run, const EncodeOptions& options, const StageClock& clock,
                              const Observer& observer);

}  // namespace gim

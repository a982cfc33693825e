// Chooses the number of tiles, and whether they keep the surface's creases: codes several and keeps the best file.
#pragma once

#include "encoder/base/stage_clock.h"
#include "encoder/layout/encode_once.h"
#include "encoder/tiles/make_tiles.h"

namespace gim {

// If the options leave the number open and the target is searched for, tries several. A surface with creases is coded
// with and without them. Where the target is not searched for, tiles keep them if that leads to a file. A run that is
// sure to lose ends early (contest.h). Returns the best file. Only the first run shows pictures. The times are those of all
// runs. surfaces: of the runs.
Result<Encoded> best_of_tiles(const EncodeOnce& run, const EncodeOptions& options, const StageClock& clock,
                              const Observer& observer, TileableSurfaces& surfaces);

}  // namespace gim

// Chooses the number of tiles: codes several and keeps the best file.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/base/stage_clock.h"
#include "encoder/layout/encode_once.h"

namespace gim {

inline constexpr uint32_t kUsualTiles = 120;

// The options, once for each number of tiles that best_of_tiles() tries: several if they leave the number open and the
// target is searched for.
std::vector<EncodeOptions> tile_variants(const EncodeOptions& options);

// Estimates what each number costs. Codes the cheapest, and those that cost almost the same; one that is sure to lose ends
// early (contest.h). Returns the best file. The times are those of all runs.
Result<Encoded> best_of_tiles(const CodingRuns& runs, const EncodeOptions& options, const StageClock& clock);

}  // namespace gim

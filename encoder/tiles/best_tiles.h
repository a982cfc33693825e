// Chooses the number of tiles, and whether they keep the surface's creases: codes several and keeps the best file.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/code/rate_target.h"
#include "encoder/layout/encode_once.h"

namespace gim {

inline constexpr uint32_t kUsualTiles = 120;

// Returns a number of tiles whose atlas has hardly fewer samples than these: of those for each size of tile, the one
// nearest to the usual number.
uint32_t tiles_that_fill(uint64_t samples);

struct TriedTiles {
    EncodeOptions options;
    Estimate estimate;
};

// Estimates what tiles cost in the number that the options name, or in the usual one: with creases and without, if the
// surface has any. Returns those whose images could be made, the cheapest first, or the first error. Only for targets that
// are searched for.
Result<std::vector<TriedTiles>> try_usual_tiles(const CodingRuns& runs, const EncodeOptions& options, bool has_creases);

// The options of the first of them: the usual number, and creases if there are any.
EncodeOptions usual_tiles(const EncodeOptions& options, bool has_creases);

// The options of all that try_tiles() is likely to try.
std::vector<EncodeOptions> likely_tiles(const EncodeOptions& options, bool has_creases);

// The same; goes on in other numbers if the options leave the number open.
Result<std::vector<TriedTiles>> try_tiles(const CodingRuns& runs, const EncodeOptions& options, bool has_creases);

// If the target is searched for, codes the cheapest of try_tiles(), and those that cost almost the same; one that is sure
// to lose ends early (contest.h). Else tiles keep creases if that leads to a file; without loss, they fill
// options.samples. Returns the best file. is_brief_enough: codes only the cheapest.
Result<Encoded> best_of_tiles(const CodingRuns& runs, const EncodeOptions& options, bool has_creases,
                              bool is_brief_enough);

}  // namespace gim

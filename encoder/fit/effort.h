// What the levels of EncodeOptions::effort do.
#pragma once

#include <cstddef>
#include <cstdint>

#include "encoder/fit/fit_rounds.h"
#include "gim/encoder.h"

namespace gim {

inline constexpr uint32_t kLeastEffort = 1, kMostEffort = 9;

struct Effort {
    FitRounds rounds;
    size_t cuts;      // squares: among how many cuts a search chooses
    bool all_sides;   // squares, charts: a search that may take fewer samples than asked for also tries all of them
    bool all_counts;  // tiles: a search tries other numbers of tiles than the usual one
    bool races;       // Layout::kAuto: tiles race against squares
};

// effort: kLeastEffort..kMostEffort.
const Effort& effort_of(uint32_t effort);
inline const Effort& effort_of(const EncodeOptions& options) { return effort_of(options.effort); }

}  // namespace gim

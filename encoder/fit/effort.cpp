#include "encoder/fit/effort.h"

#include <algorithm>
#include <array>

namespace gim {

namespace {

//   rounds: cycles, free, held, steps     cuts  all_sides  all_counts  races
constexpr std::array<Effort, kMostEffort> kEfforts = {{
    {{0, 2, 1, 15}, 1, false, false, false},
    {{1, 3, 2, 20}, 1, false, false, false},
    {{1, 4, 2, 40}, 2, false, false, false},
    {{2, 6, 3, 40}, 3, true, false, true},
    {{4, 6, 3, 40}, 6, true, true, true},
    {{5, 6, 3, 40}, 6, true, true, true},
    {{6, 6, 3, 40}, 6, true, true, true},
    {{7, 6, 3, 40}, 6, true, true, true},
    {{8, 6, 3, 40}, 6, true, true, true},
}};
static_assert(EncodeOptions{}.effort == 5);

}  // namespace

const Effort& effort_of(uint32_t effort) { return kEfforts[std::clamp(effort, kLeastEffort, kMostEffort) - 1]; }

}  // namespace gim

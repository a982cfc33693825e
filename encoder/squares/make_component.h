// Makes the square of one component, by the first cut and at the first side that lead to one.
//
// A surface of high genus, or with many boundaries, has more cut-paths than a small square has room for. And a map may
// run out of floating-point precision along one cut and not along another.
#pragma once

#include <optional>

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/squares/make_square.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

struct SideLimits {
    uint32_t most = 0;        // largest side that the component may take if its own does not do
    bool is_largest = false;  // no component has a larger side
};

// options.side: the component's own. Chooses among cuts for the largest components only. If `preference` is not known,
// it is set to the one that was chosen. Cost of a cut that does not fit: that of finding it on a coarse mesh.
Result<MadeSquare> make_component(const Mesh& mesh, EncodeOptions options, const SideLimits& limits, StageClock& clock,
                                  const Observer& observer, std::optional<CutPreference>& preference);

}  // namespace gim

// The arithmetic of lifting steps on tiles (format/tile_steps.h): the loops in which their time goes.
#pragma once

#include "format/lift_number.h"
#include "format/tile_steps.h"

namespace gim {

// Lift: LiftInteger or LiftFloat.
template <class Lift>
void lift_tile_rows(const LiftStep& step, void* samples, const RowBlock& block);
template <class Lift>
void lift_edge(const LiftStep& step, void* samples, const EdgeRun& run);

}  // namespace gim

// Lets packed charts grow into the free samples around them.
//
// This is not in the papers. A packing leaves a fifth of the samples undefined. The stretch of the charts in the given
// rectangle is what counts, and empty samples do not help it. A map a little larger than its optimum, or bent a little,
// loses in second order only. So every chart gets a territory: the samples nearest to it, with a gutter to other
// territories and between the banks of its own inlets. Its map is relaxed there. It presses outwards until the
// territory's wall or its own stretch stops it. If the new map makes no disk there, it is taken back step by step.
//
// In:  charts, their maps and where they are packed. Out: new maps and masks; poses and the rectangle stay.
// Cost: about ten sparse factorizations per chart and round. Deterministic at any thread count.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/charts/chart_parametrize.h"
#include "encoder/charts/chart_set.h"
#include "encoder/charts/pack.h"

namespace gim {

struct InflateOptions {
    double area_weight = 0.6;  // of area in a map's energy; 1: no pressure; near 0: fills the territory at any price
    int rounds = 2;            // each shares out the territories again
    int most_steps = 6;        // Newton steps per chart and round
    uint32_t threads = 0;      // 0: all cores
};

// `importance` per face of the surface (empty: 1).
void inflate(const std::vector<Chart>& charts, const std::vector<double>& importance, const InflateOptions& options,
             std::vector<ChartMap>& maps, Packing& packing);

}  // namespace gim

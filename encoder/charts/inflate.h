// Lets packed charts grow into the free samples around them.
//
// Not in the papers. A packing leaves a fifth of the samples undefined. What counts in the end is the stretch of the charts
// in a rectangle that is given: empty samples help nobody, while a map that is a little larger, or bent a little, than
// its own optimum loses in the second order only. So every chart gets a territory - the samples nearest to it, with a
// gutter to those of others and between the banks of its own inlets -, and its map is relaxed there, pressing outwards
// until the territory's wall or its own stretch stops it. A map that does not come out as a disk in its territory is
// taken back by parts.
//
// In:  charts, their maps, where they are packed. Out: new maps and masks; poses and the rectangle stay.
// Cost: some ten sparse factorizations per chart and round. Deterministic at any thread count.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/charts/chart_parametrize.h"
#include "encoder/charts/chart_set.h"
#include "encoder/charts/pack.h"

namespace gim {

struct InflateOptions {
    double area_weight = 0.6;  // of area in a map's energy; 1: no pressure; near 0: all of the territory at any price
    int rounds = 2;            // territories are shared out anew in each
    int most_steps = 6;        // Newton steps per chart and round
    uint32_t threads = 0;      // 0: all cores
};

// `importance` per face of the surface (empty: 1).
void inflate(const std::vector<Chart>& charts, const std::vector<double>& importance, const InflateOptions& options,
             std::vector<ChartMap>& maps, Packing& packing);

}  // namespace gim

// Squeezes placed charts into ever smaller rectangles, letting them overlap on the way and parting them again.
//
// Guided local search as in Egeblad, Nielsen, Odgaard. Fast neighborhood search for two- and three-dimensional nesting
// problems. EJOR 2007, with the multiplicative weights per pair that later strip packers use. We differ: charts are
// bitmaps in many orientations. A move looks close by, and over all of the rectangle in a few orientations chosen by
// chance: on coarse cells first, then sample by sample around the best of them. The overlap of a place is a sum over the
// chart's runs of samples, two look-ups each in running sums of the weighted charts already there.
//
// Deterministic for a seed, at any thread count: the effort is counted in moves, not in time.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/charts/piece.h"

namespace gim {

struct SqueezeOptions {
    uint64_t most_moves = 6000;  // some 0.3 ms each for 65,536 samples
    uint64_t least_area = 0;     // stop when the rectangle is as small as that
    double most_aspect = 4;      // longer side over shorter side stays below this
    uint64_t seed = 1;
};

// In:  any layout in which every piece lies inside the rectangle. Out: the same without overlap, or a layout without
//      spots when it was not found. `moves` counts up.
PieceLayout separate(const std::vector<Shape>& shapes, PieceLayout layout, const SqueezeOptions& options,
                     uint64_t& moves);

// In:  a layout without overlap. Out: one in the smallest rectangle that was found.
PieceLayout squeeze(const std::vector<Shape>& shapes, PieceLayout layout, const SqueezeOptions& options,
                    uint64_t& moves);

}  // namespace gim

// Squeezes placed charts into ever smaller rectangles. Charts overlap on the way and are parted again.
//
// Guided local search as in Egeblad, Nielsen, Odgaard. Fast neighborhood search for two- and three-dimensional nesting
// problems. EJOR 2007, with the multiplicative weights per pair that later strip packers use. We differ from the paper:
// charts are bitmaps in many orientations. A move looks close by. It also looks over the whole rectangle in a few
// random orientations: on coarse cells first, then sample by sample around the best of them. The overlap at a place is
// a sum over the chart's runs of samples. Each run takes two look-ups in running sums of the other charts' weights.
//
// Deterministic for a seed at any thread count, because the effort is counted in moves, not in time.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/charts/piece.h"

namespace gim {

struct SqueezeOptions {
    uint64_t most_moves = 6000;  // about 0.3 ms each for 65,536 samples
    uint64_t least_area = 0;     // stops when the rectangle is as small as this, in samples
    double most_aspect = 4;      // longer side over shorter side stays below this
    uint64_t seed = 1;
};

// Parts charts that overlap. Adds its moves to `moves`.
// In:  any layout in which every piece lies inside the rectangle. Out: one without overlap, or without spots if none
//      was found.
PieceLayout separate(const std::vector<Shape>& shapes, PieceLayout layout, const SqueezeOptions& options,
                     uint64_t& moves);

// Shrinks the rectangle. Adds its moves to `moves`.
// In:  a layout without overlap. Out: one in the smallest rectangle that was found.
PieceLayout squeeze(const std::vector<Shape>& shapes, PieceLayout layout, const SqueezeOptions& options,
                    uint64_t& moves);

}  // namespace gim

// The passes of the repair of folds (fold_repair.h), over any coded image.
//
// Finds faces of the decoded surface that look away from the reference. Changes single coefficients around them by one
// step, where that pays. A change pays if what it saves in folds is worth more than what it adds in bits and in
// distance. Rate-distortion optimised quantization does the same for distance alone: Ramchandran, Vetterli.
// Rate-Distortion Optimal Fast Thresholding with Complete JPEG/MPEG Decoder Compatibility. 1994.
//
// Each pass decodes the image. It finds the best change at folded cells that are not near each other, several at once, and
// applies them in order, as far as they still pay. Then it goes on with the cells between. It assumes that the frames of
// finer details stay. The next pass sees what the decoder really does. Where several neighbours are folded, one pass also
// tries coarser details. It decodes for each of these, since frames turn with them.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/fit/coded_image.h"
#include "encoder/fit/fitter.h"
#include "encoder/fit/fold_state.h"
#include "encoder/image/gluing.h"

namespace gim {

// The last repair of a file, and those between the rounds of a fit. The latter must be cheap: what they spend on a fold,
// the next rounds undo. With the last ones' price, files take 3 to 5 % more bytes and have more folds.
inline constexpr RepairEffort kLastRepair = {8, 15, 10}, kRepairBetween = {1, 2, 5};
// Files of tiles are small for what they show. With the price of squares, a horse at 60 dB takes 6 % more bytes than without
// a last repair, and half as many faces are folded; with this one 1 %.
inline constexpr RepairEffort kLastRepairOfTiles = {8, 3, 2};

class FoldPasses {
  public:
    // Keeps references to gluing and reference. front: the sign that makes the image face outwards.
    FoldPasses(const GridGluing& gluing, const FitReference& reference, const FitFrame& frame, double front);

    // Makes at most effort.passes passes. Deterministic at any number of threads. Leaves an image alone where three in a
    // hundred cells seem folded: then sheets lie nearer to each other than the samples to them, and repairs would only
    // move samples away. Cost: a decoding for each pass and each coarse trial, and about a millisecond for each folded
    // cell.
    void repair(CodedImage& image, const RepairEffort& effort);

  private:
    friend class FoldPass;

    const GridGluing& gluing_;
    FitFrame frame_;
    const FitReference& reference_;
    double front_;
    std::vector<uint32_t> nearest_;  // per slot: a face of the reference that was near
    std::vector<uint8_t> is_stuck_;  // per cell: no change pays, and nothing near it has changed since
};

}  // namespace gim

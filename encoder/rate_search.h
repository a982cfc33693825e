// Finds the file that meets a rate target.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/code/contest.h"
#include "encoder/code/rate_target.h"
#include "encoder/layout/layout_images.h"
#include "encoder/surface/compare_meshes.h"
#include "gim/encoder.h"

namespace gim {

// Codes the images at the quantizer that options.rate asks for:
//   lossless  keeps the quantized images exactly
//   quality   does not search
//   psnr      returns the smallest file found whose PSNR is at least `value`; an Error names the best PSNR in reach
//   error     returns the smallest file found whose largest distance is at most `value`, which is in diagonals; an Error
//             names the distance in reach
//   bytes     returns the best file found of at most `value` bytes, or an Error (within_budget.h); the smallest one in
//             reach for kFewestBytes
// Images that are fitted to their quantizer are fitted again for each quantizer; they keep the last fit. Constants:
// code/rate_target.h.
class RateSearch {
  public:
    using Bytes = std::vector<uint8_t>;

    // Keeps references to images, reference and clock. parameters: planes and text.
    RateSearch(LayoutImages& images, CodingParameters parameters, const EncodeOptions& options,
               const ReferenceSurface& reference, StageClock& clock);
    ~RateSearch();

    // Fits briefly to about the target's quantizer. run() goes on from there. near: the quantizer of other images of the
    // surface that meet the target. Only for targets that are searched for. Cost: up to 4 files, one with a good `near`; of
    // 5 rounds of CodedFit each.
    Result<Estimate> estimate(std::optional<double> near);

    // contest: a search that is sure to lose returns an Error instead. Cost: up to about 16 files, or 32 for bytes and
    // error if nothing is fitted; each fitted, decoded and compared.
    Result<Bytes> run(const Contest& contest);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gim

// What layouts need to code an image several times and keep the best file.
#pragma once

#include <functional>

#include "encoder/code/contest.h"
#include "gim/encoder.h"

namespace gim {

// Makes and codes images with these options. contest: the other runs.
using EncodeOnce =
    std::function<Result<Encoded>(const EncodeOptions& options, const Contest& contest, const Observer& observer)>;

// Returns whether the run gives a better file for the target than the best one so far.
inline bool improves(const Result<Encoded>& now, const Result<Encoded>& best, const RateTarget& rate) {
    if (!now.ok() || !best.ok()) return now.ok();
    return rate.kind == RateTarget::Kind::kBytes ? now.value().report.error.psnr > best.value().report.error.psnr
                                                 : now.value().bytes.size() < best.value().bytes.size();
}

// The contest of a run that follows the best one.
inline Contest contest_with(const Result<Encoded>& best) {
    return {best.ok() ? double(best.value().bytes.size()) : 0, false};
}

}  // namespace gim

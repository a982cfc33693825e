// What layouts need to code an image several times and keep the best file.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/code/contest.h"
#include "encoder/code/rate_target.h"
#include "gim/encoder.h"

namespace gim {

struct CodingRuns {
    // Makes and codes images with these options. contest: the other runs.
    std::function<Result<Encoded>(const EncodeOptions& options, const Contest& contest)> code;
    // Makes images with these options, and estimates what their file costs. near: the quantizer of an earlier estimate.
    // The images wait for code().
    std::function<Result<Estimate>(const EncodeOptions& options, std::optional<double> near)> estimate;
    // Makes the images of several options at once, which takes less time than one by one. They wait for estimate() and code(),
    // which also tell what fails. May be empty.
    std::function<void(const std::vector<EncodeOptions>& all)> make_ahead = {};
};

// Returns whether the run gives a better file for the target than the best one so far.
inline bool improves(const Result<Encoded>& now, const Result<Encoded>& best, const RateTarget& rate) {
    if (!now.ok() || !best.ok()) return now.ok();
    return rate.kind == RateTarget::Kind::kBytes ? now.value().report.error.psnr > best.value().report.error.psnr
                                                 : now.value().bytes.size() < best.value().bytes.size();
}

// The contest of a run that follows the best one.
inline Contest contest_with(const Result<Encoded>& best) {
    return {best.ok() ? double(best.value().bytes.size()) : 0, false, false};
}

// The contest of a run that has rivals of both.
inline Contest joined(const Contest& a, const Contest& b) {
    const bool both = a.rival_bytes > 0 && b.rival_bytes > 0;
    return {both ? std::min(a.rival_bytes, b.rival_bytes) : std::max(a.rival_bytes, b.rival_bytes),
            a.is_finer_to_come || b.is_finer_to_come, a.is_target_rough || b.is_target_rough};
}

}  // namespace gim

#include "encoder/best_size.h"

#include <algorithm>
#include <utility>

#include "encoder/code/rate_target.h"
#include "encoder/fit/effort.h"

namespace gim {

namespace {

// Charts of fewer than half of these samples are not tried.
constexpr uint32_t kLeastSamplesToHalve = 8192;

EncodeOptions halved(EncodeOptions options) {
    if (options.layout == Layout::kMcgim) {
        options.samples /= 2;
        return options;
    }
    options.side = (options.side - 1) / 2 + 1;
    options.node_side = std::min(options.node_side, options.side);
    return options;
}

bool is_large(const EncodeOptions& options) {
    return options.layout == Layout::kMcgim ? options.samples >= kLeastSamplesToHalve
                                            : options.side >= RateSearchValues::kLeastSideToHalve;
}

// Charts take half of their samples, not a quarter. So they are worth a trial at any target.
bool may_halve(const EncodeOptions& options) {
    const RateTarget& rate = options.rate;
    const bool is_fine =
        (rate.kind == RateTarget::Kind::kPsnr && rate.value > RateSearchValues::kMostPsnrOfSmallerSides) ||
        (rate.kind == RateTarget::Kind::kMaxError && rate.value < RateSearchValues::kLeastErrorOfSmallerSides);
    const bool is_worth_it = options.layout == Layout::kMcgim || (options.layout == Layout::kGim && !is_fine);
    return is_worth_it && options.try_smaller_sides && is_large(options) && is_searched(rate);
}

}  // namespace

std::vector<EncodeOptions> size_variants(const EncodeOptions& options) {
    if (!may_halve(options)) return {options};
    return {halved(options), options};
}

namespace {

// Halves as long as that gives a better file, and puts that into `best`. Returns whether there was one.
bool try_halves(const CodingRuns& runs, EncodeOptions options, bool may_end_early, Result<Encoded>& best) {
    bool any = false;
    while (is_large(options)) {
        options = halved(options);
        auto half = runs.code(options, may_end_early ? contest_with(best) : Contest{});
        if (!improves(half, best, options.rate)) break;
        best = std::move(half);
        any = true;
    }
    return any;
}

// Brief fits of charts are too far from full ones to tell who is sure to lose. So each number of samples is coded to its
// end, but all of them only if a quarter is not better than the half.
Result<Encoded> best_of_samples(const CodingRuns& runs, const EncodeOptions& whole) {
    const EncodeOptions half = halved(whole);
    auto best = runs.code(half, {});
    const bool is_enough = try_halves(runs, half, false, best) || (best.ok() && !effort_of(whole).all_sides);
    if (is_enough) return best;
    auto of_whole = runs.code(whole, {});
    return improves(of_whole, best, whole.rate) ? std::move(of_whole) : std::move(best);
}

}  // namespace

Result<Encoded> best_of_sizes(const CodingRuns& runs, const EncodeOptions& whole) {
    if (!may_halve(whole)) return runs.code(whole, {});
    if (whole.layout == Layout::kMcgim) return best_of_samples(runs, whole);
    const EncodeOptions half = halved(whole);
    auto best = runs.code(half, {0, true});
    if (best.ok() && !effort_of(whole).all_sides) return best;
    auto of_whole = runs.code(whole, contest_with(best));
    if (!best.ok() || improves(of_whole, best, whole.rate)) return of_whole;
    try_halves(runs, half, true, best);
    return best;
}

}  // namespace gim

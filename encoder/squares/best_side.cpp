#include "encoder/squares/best_side.h"

#include <algorithm>
#include <utility>

#include "encoder/code/rate_target.h"

namespace gim {

namespace {

EncodeOptions halved(EncodeOptions options) {
    options.side = (options.side - 1) / 2 + 1;
    options.node_side = std::min(options.node_side, options.side);
    return options;
}

bool may_halve(const EncodeOptions& options) {
    const RateTarget& rate = options.rate;
    const bool is_fine =
        (rate.kind == RateTarget::Kind::kPsnr && rate.value > RateSearchValues::kMostPsnrOfSmallerSides) ||
        (rate.kind == RateTarget::Kind::kMaxError && rate.value < RateSearchValues::kLeastErrorOfSmallerSides);
    return options.layout == Layout::kGim && options.try_smaller_sides &&
           options.side >= RateSearchValues::kLeastSideToHalve && is_searched(rate) && !is_fine;
}

}  // namespace

std::vector<EncodeOptions> side_variants(const EncodeOptions& options) {
    if (!may_halve(options)) return {options};
    return {halved(options), options};
}

Result<Encoded> best_of_sides(const CodingRuns& runs, const EncodeOptions& whole) {
    if (!may_halve(whole)) return runs.code(whole, {});
    EncodeOptions options = halved(whole);
    auto best = runs.code(options, {0, true});
    auto of_whole = runs.code(whole, contest_with(best));
    if (!best.ok() || improves(of_whole, best, whole.rate)) {
        best = std::move(of_whole);
    } else {
        while (options.side >= RateSearchValues::kLeastSideToHalve) {
            options = halved(options);
            auto half = runs.code(options, contest_with(best));
            if (!improves(half, best, whole.rate)) break;
            best = std::move(half);
        }
    }
    return best;
}

}  // namespace gim

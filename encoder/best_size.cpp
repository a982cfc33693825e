#include "encoder/best_size.h"

#include <algorithm>
#include <utility>

#include "encoder/code/rate_target.h"

namespace gim {

namespace {

// Charts of fewer samples have more border than inside.
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

Result<Encoded> best_of_sizes(const CodingRuns& runs, const EncodeOptions& whole) {
    if (!may_halve(whole)) return runs.code(whole, {});
    EncodeOptions options = halved(whole);
    auto best = runs.code(options, {0, true});
    auto of_whole = runs.code(whole, contest_with(best));
    if (!best.ok() || improves(of_whole, best, whole.rate)) {
        best = std::move(of_whole);
    } else {
        while (is_large(options)) {
            options = halved(options);
            auto half = runs.code(options, contest_with(best));
            if (!improves(half, best, whole.rate)) break;
            best = std::move(half);
        }
    }
    return best;
}

}  // namespace gim

#include "encoder/tiles/best_tiles.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "encoder/code/rate_target.h"

namespace gim {

namespace {

constexpr uint32_t kOthers[] = {180, 60};  // more for limbs and high rates, fewer for what is nearly a box

struct Estimated {
    EncodeOptions options;
    double log_bytes;
};

// Returns the variants whose images could be made, the cheapest first. first_error: of those that could not.
std::vector<Estimated> estimate_all(const CodingRuns& runs, const std::vector<EncodeOptions>& variants,
                                    std::optional<Error>& first_error) {
    std::vector<Estimated> all;
    std::optional<double> near;
    for (const EncodeOptions& variant : variants) {
        const auto estimate = runs.estimate(variant, near);
        if (estimate.ok()) {
            all.push_back({variant, estimate.value().log_bytes});
            near = estimate.value().quantizer;
        } else if (!first_error) {
            first_error = estimate.error();
        }
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Estimated& a, const Estimated& b) { return a.log_bytes < b.log_bytes; });
    return all;
}

}  // namespace

std::vector<EncodeOptions> tile_variants(const EncodeOptions& options) {
    if (options.tiles > 0) return {options};
    std::vector<EncodeOptions> variants(1, options);
    variants[0].tiles = kUsualTiles;
    if (!is_searched(options.rate)) return variants;
    for (const uint32_t tiles : kOthers) {
        variants.push_back(options);
        variants.back().tiles = tiles;
    }
    return variants;
}

Result<Encoded> best_of_tiles(const CodingRuns& runs, const EncodeOptions& options, const StageClock& clock) {
    const std::vector<EncodeOptions> variants = tile_variants(options);
    if (variants.size() == 1) return runs.code(variants[0], {});
    std::optional<Error> first_error;
    const std::vector<Estimated> all = estimate_all(runs, variants, first_error);
    if (all.empty()) return *first_error;
    auto best = runs.code(all[0].options, {});
    for (size_t k = 1; k < all.size(); ++k) {
        const bool is_close = all[k].log_bytes < all[0].log_bytes + RateSearchValues::kEstimateNoise;
        if (best.ok() && !is_close) continue;
        auto other = runs.code(all[k].options, contest_with(best));
        if (improves(other, best, options.rate)) best = std::move(other);
    }
    if (best.ok()) {
        best.value().report.times = clock.times();
        best.value().report.seconds = clock.seconds();
    }
    return best;
}

}  // namespace gim

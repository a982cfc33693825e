#include "encoder/tiles/best_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace gim {

namespace {

constexpr std::array<uint32_t, 2> kOthers = {180, 60};  // more for limbs and high rates, fewer for what is nearly a box
// Between creases, fewer tiles are enough.
constexpr std::array<uint32_t, 2> kOthersWithCreases = {80, 55};

// Brief fits may rank images wrongly whose bytes differ by less than this share. Those of creases tell less.
constexpr double kNoise = 0.05, kNoiseWithCreases = 0.25;

class Trials {
  public:
    explicit Trials(const CodingRuns& runs) : runs_(runs) {}

    void add(const EncodeOptions& options) {
        const auto estimate = runs_.estimate(options, near_);
        if (estimate.ok()) {
            tried_.push_back({options, estimate.value()});
            near_ = estimate.value().quantizer;
        } else if (!first_error_) {
            first_error_ = estimate.error();
        }
        std::stable_sort(tried_.begin(), tried_.end(), [](const TriedTiles& a, const TriedTiles& b) {
            return a.estimate.log_bytes < b.estimate.log_bytes;
        });
    }
    const std::vector<TriedTiles>& cheapest_first() const { return tried_; }
    const std::optional<Error>& first_error() const { return first_error_; }

  private:
    const CodingRuns& runs_;
    std::vector<TriedTiles> tried_;
    std::optional<double> near_;
    std::optional<Error> first_error_;
};

EncodeOptions usual(const EncodeOptions& given, bool has_creases) {
    EncodeOptions options = given;
    options.creases = given.creases && has_creases;
    if (options.tiles == 0) options.tiles = kUsualTiles;
    return options;
}

// Without a search: tiles keep creases if that leads to a file.
Result<Encoded> code_once(const CodingRuns& runs, EncodeOptions options) {
    auto encoded = runs.code(options, {});
    if (encoded.ok() || !options.creases) return encoded;
    options.creases = false;
    auto without = runs.code(options, {});
    return without.ok() ? std::move(without) : std::move(encoded);
}

}  // namespace

Result<std::vector<TriedTiles>> try_tiles(const CodingRuns& runs, const EncodeOptions& given, bool has_creases) {
    EncodeOptions options = usual(given, has_creases);
    Trials trials(runs);
    trials.add(options);
    if (options.creases) {
        options.creases = false;
        trials.add(options);
    }
    if (trials.cheapest_first().empty()) return *trials.first_error();
    if (given.tiles == 0) {
        options.creases = trials.cheapest_first()[0].options.creases;
        for (const uint32_t tiles : options.creases ? std::span<const uint32_t>(kOthersWithCreases) : kOthers) {
            options.tiles = tiles;
            trials.add(options);
        }
    }
    return trials.cheapest_first();
}

Result<Encoded> best_of_tiles(const CodingRuns& runs, const EncodeOptions& options, bool has_creases) {
    if (!is_searched(options.rate)) return code_once(runs, usual(options, has_creases));
    GIM_TRY(tried, try_tiles(runs, options, has_creases));
    auto best = runs.code(tried[0].options, {});
    for (size_t k = 1; k < tried.size(); ++k) {
        const auto& [variant, estimate] = tried[k];
        const double noise = std::log1p(variant.creases ? kNoiseWithCreases : kNoise);
        if (best.ok() && estimate.log_bytes > tried[0].estimate.log_bytes + noise) continue;
        auto other = runs.code(variant, variant.creases ? Contest{} : contest_with(best));
        if (improves(other, best, options.rate)) best = std::move(other);
    }
    return best;
}

}  // namespace gim

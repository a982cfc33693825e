#include "encoder/tiles/best_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "encoder/fit/effort.h"
#include "format/quad_complex.h"
#include "format/tile_atlas.h"

namespace gim {

namespace {

constexpr uint32_t kMore = 180, kFewer = 60;  // more for limbs and high rates, fewer for what is nearly a box
constexpr std::array<uint32_t, 2> kOthers = {kMore, kFewer};
// Bytes for each tile above which more tiles probably take fewer bytes. A tile by itself takes about 4.
constexpr double kDearTile = 25;
// Between creases, fewer tiles are enough.
constexpr std::array<uint32_t, 2> kOthersWithCreases = {80, 55};

// Brief fits may rank images wrongly whose bytes differ by less than this share. Those of creases tell less.
constexpr double kNoise = 0.05, kNoiseWithCreases = 0.25;

// By how much of its bytes a number of tiles must beat the usual one, so that no further number is tried.
constexpr double kClearGain = 0.02;

class Trials {
  public:
    explicit Trials(const CodingRuns& runs) : runs_(runs) {}

    // Makes the images of trials that follow.
    void make_ahead(const std::vector<EncodeOptions>& all) const {
        if (runs_.make_ahead) runs_.make_ahead(all);
    }

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

EncodeOptions in_number(EncodeOptions options, uint32_t tiles) {
    options.tiles = tiles;
    return options;
}

// With creases and without, if the surface has any.
std::vector<EncodeOptions> in_usual_number(const EncodeOptions& given, bool has_creases) {
    std::vector<EncodeOptions> all = {usual_tiles(given, has_creases)};
    if (!all[0].creases) return all;
    all.push_back(all[0]);
    all[1].creases = false;
    return all;
}

bool may_take_other_numbers(const EncodeOptions& options) {
    return options.tiles == 0 && effort_of(options).all_counts;
}

Result<Trials> tried_in_usual_number(const CodingRuns& runs, const EncodeOptions& given, bool has_creases) {
    const std::vector<EncodeOptions> all = in_usual_number(given, has_creases);
    Trials trials(runs);
    if (all.size() > 1) trials.make_ahead(all);
    for (const EncodeOptions& options : all) trials.add(options);
    if (trials.cheapest_first().empty()) return *trials.first_error();
    return trials;
}

std::vector<EncodeOptions> in_other_numbers(const EncodeOptions& usual) {
    std::vector<EncodeOptions> others;
    for (const uint32_t tiles : usual.creases ? kOthersWithCreases : kOthers) others.push_back(in_number(usual, tiles));
    return others;
}

// Tries the number that is probably better than the usual one. Tries the other one unless the first is clearly better.
void try_other_numbers(Trials& trials, const TriedTiles& usual) {
    const double bytes = bytes_at(usual.options.rate, usual.estimate.log_bytes);
    const bool is_dear = bytes > kDearTile * usual.options.tiles;
    const uint32_t likely = is_dear ? kMore : kFewer;
    const EncodeOptions first = in_number(usual.options, likely);
    const EncodeOptions second = in_number(usual.options, is_dear ? kFewer : kMore);
    trials.make_ahead({first, second});
    trials.add(first);
    const TriedTiles& best = trials.cheapest_first()[0];
    if (best.options.tiles == likely && best.estimate.log_bytes < usual.estimate.log_bytes - std::log1p(kClearGain))
        return;
    trials.add(second);
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

uint32_t tiles_that_fill(uint64_t samples) {
    uint32_t best = kUsualTiles;
    double least = HUGE_VAL;
    for (uint32_t exponent = 1; exponent <= kMostTileExponent; ++exponent) {
        const uint32_t intervals = 1u << exponent;
        const uint64_t most = samples / (uint64_t{intervals + 1} * (intervals + 1));
        auto tiles = static_cast<uint32_t>(std::min<uint64_t>(most, kMostTiles));
        while (tiles > 0 && TileAtlas(tiles, intervals).samples() > samples) --tiles;
        const double away = tiles > 0 ? std::abs(std::log(double(tiles) / kUsualTiles)) : HUGE_VAL;
        if (away < least) best = tiles, least = away;
    }
    return best;
}

EncodeOptions usual_tiles(const EncodeOptions& given, bool has_creases) {
    EncodeOptions options = given;
    options.creases = given.creases && has_creases;
    const bool lossless = given.rate.kind == RateTarget::Kind::kLossless;
    if (options.tiles == 0) options.tiles = lossless ? tiles_that_fill(options.samples) : kUsualTiles;
    return options;
}

std::vector<EncodeOptions> likely_tiles(const EncodeOptions& given, bool has_creases) {
    std::vector<EncodeOptions> all = in_usual_number(given, has_creases);
    if (!may_take_other_numbers(given)) return all;
    const std::vector<EncodeOptions> others = in_other_numbers(all[0]);
    all.insert(all.end(), others.begin(), others.end());
    return all;
}

Result<std::vector<TriedTiles>> try_usual_tiles(const CodingRuns& runs, const EncodeOptions& given, bool has_creases) {
    GIM_TRY(trials, tried_in_usual_number(runs, given, has_creases));
    return trials.cheapest_first();
}

Result<std::vector<TriedTiles>> try_tiles(const CodingRuns& runs, const EncodeOptions& given, bool has_creases) {
    GIM_TRY(trials, tried_in_usual_number(runs, given, has_creases));
    if (!may_take_other_numbers(given)) return trials.cheapest_first();
    const TriedTiles first = trials.cheapest_first()[0];
    if (first.options.creases) {
        const std::vector<EncodeOptions> others = in_other_numbers(first.options);
        trials.make_ahead(others);
        for (const EncodeOptions& other : others) trials.add(other);
    } else {
        try_other_numbers(trials, first);
    }
    return trials.cheapest_first();
}

Result<Encoded> best_of_tiles(const CodingRuns& runs, const EncodeOptions& options, bool has_creases,
                              bool is_brief_enough) {
    if (!is_searched(options.rate)) return code_once(runs, usual_tiles(options, has_creases));
    GIM_TRY(tried, try_tiles(runs, options, has_creases));
    auto best = runs.code(tried[0].options, {});
    if (is_brief_enough) return best;
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

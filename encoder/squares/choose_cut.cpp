#include "encoder/squares/choose_cut.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "encoder/base/at_once.h"
#include "encoder/code/rate_target.h"
#include "encoder/fit/effort.h"
#include "encoder/squares/coding_trial.h"

namespace gim {

namespace {

constexpr std::array<CutPreference, 6> kPreferences = {
    {{}, {0.4, 0}, {0.03, 0.003}, {0.4, 0.007}, {0.1, 0}, {0.6, 0, 2}}};

struct Candidate {
    CutPreference preference;
    std::optional<CutSurface> cut;
    std::optional<MadeSquare> square;
    double log_bytes = std::numeric_limits<double>::infinity();
};

// Cuts the surface by every preference and returns the cuts that differ.
std::vector<Candidate> cut_in_several_ways(const Mesh& mesh, const EncodeOptions& options, const StageClock& clock) {
    const CuttableSurface surface = make_cuttable(mesh, options);
    std::vector<Candidate> attempts;
    for (const CutPreference& preference : std::span(kPreferences).first(effort_of(options).cuts))
        attempts.push_back({preference, {}, {}});
    for_each_at_once(attempts.size(), clock, [&](size_t i) {
        Candidate& attempt = attempts[i];
        auto cut = cut_open(surface, options, attempt.preference);
        if (cut.ok()) attempt.cut = std::move(cut.value());
    });
    std::vector<Candidate> candidates;
    for (Candidate& attempt : attempts) {
        if (!attempt.cut) continue;
        const bool is_known = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& other) {
            return other.cut->cut_length == attempt.cut->cut_length &&
                   other.cut->boundary.sideband == attempt.cut->boundary.sideband;
        });
        if (!is_known) candidates.push_back(std::move(attempt));
    }
    return candidates;
}

}  // namespace

std::span<const CutPreference> cut_preferences() { return kPreferences; }

bool may_choose_cut(const EncodeOptions& options) {
    return is_searched(options.rate) && options.fit == FitStrength::kAuto;
}

std::optional<ChosenCut> choose_cut(const Mesh& mesh, const EncodeOptions& options, StageClock& clock) {
    clock.begin(Stage::kCut);
    std::vector<Candidate> candidates = cut_in_several_ways(mesh, options, clock);

    clock.begin(Stage::kParametrize);
    for_each_at_once(candidates.size(), clock, [&](size_t i) {
        Candidate& candidate = candidates[i];
        StageClock unheard({});
        auto square = map_and_sample(*candidate.cut, mesh, options, unheard);
        if (square.ok()) candidate.square = std::move(square.value());
    });
    std::erase_if(candidates, [](const Candidate& candidate) { return !candidate.square; });
    if (candidates.empty()) return {};

    if (candidates.size() > 1) {
        clock.begin(Stage::kFit);
        const CodingTrial trial(mesh, options, candidates[0].square->image);
        for_each_at_once(candidates.size(), clock, [&](size_t i) {
            Candidate& candidate = candidates[i];
            const auto log_bytes = trial.log_bytes(candidate.square->image);
            if (log_bytes.ok()) candidate.log_bytes = log_bytes.value();
        });
    }
    const auto best =
        std::min_element(candidates.begin(), candidates.end(),
                         [](const Candidate& a, const Candidate& b) { return a.log_bytes < b.log_bytes; });
    return ChosenCut{std::move(*best->square), best->preference};
}

}  // namespace gim

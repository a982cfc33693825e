#include "encoder/squares/make_component.h"

#include <utility>

#include "encoder/squares/choose_cut.h"

namespace gim {

namespace {

// A larger side changes what the map looks like, but does not help for long.
constexpr int kMostSidesForMap = 3;

bool lacks_room(const Result<MadeSquare>& square) {
    return !square.ok() && square.error().stage == Stage::kBoundaryMap;
}

// Tries one cut after the other, `preference` first. Gives up early if there is no room for the cut-paths: no other cut
// has far fewer.
Result<MadeSquare> make_by_any_cut(const Mesh& mesh, const EncodeOptions& options, const CutPreference& preference,
                                   StageClock& clock, const Observer& observer) {
    auto first = make_square(mesh, options, preference, clock, observer);
    if (first.ok() || lacks_room(first)) return first;
    for (const CutPreference& other : cut_preferences()) {
        if (other == preference) continue;
        auto square = make_square(mesh, options, other, clock, observer);
        if (square.ok()) return square;
    }
    return first;
}

}  // namespace

Result<MadeSquare> make_component(const Mesh& mesh, EncodeOptions options, const SideLimits& limits, StageClock& clock,
                                  const Observer& observer, std::optional<CutPreference>& preference) {
    if (!preference && may_choose_cut(options) && limits.is_largest) {
        if (auto choice = choose_cut(mesh, options, clock)) {
            preference = choice->preference;
            if (!observer) return std::move(choice->square);
        }
    }
    if (!preference) preference = CutPreference{};
    for (int sides = 1;; ++sides, options.side = 2 * (options.side - 1) + 1) {
        auto square = make_by_any_cut(mesh, options, *preference, clock, observer);
        if (square.ok() || options.side >= limits.most) return square;
        if (!lacks_room(square) && sides >= kMostSidesForMap) return square;
    }
}

}  // namespace gim

#include "encoder/tiles/best_tiles.h"

#include <array>
#include <span>
#include <utility>

#include "encoder/code/rate_target.h"

namespace gim {

namespace {

constexpr uint32_t kUsual = 120;
constexpr std::array<uint32_t, 2> kOthers = {180, 60};  // more for limbs and high rates, fewer for what is nearly a box
// Between creases, fewer tiles are enough. Quick fits tell little of their files, so these runs go on to the end.
constexpr std::array<uint32_t, 2> kOthersWithCreases = {80, 55};

}  // namespace

Result<Encoded> best_of_tiles(const EncodeOnce& run, const EncodeOptions& whole, const StageClock& clock,
                              const Observer& observer, TileableSurfaces& surfaces) {
    const bool is_open = whole.tiles == 0, is_contest = is_searched(whole.rate);
    EncodeOptions options = whole;
    if (is_open) options.tiles = kUsual;
    surfaces.keeps_creases = true;
    auto best = run(options, {}, observer);
    const auto compete = [&](const Contest& contest) {
        auto other = run(options, contest, {});
        const bool is_better = improves(other, best, whole.rate);
        if (is_better) best = std::move(other);
        return is_better;
    };
    if (surfaces.keeps_creases && (is_contest || !best.ok())) {
        surfaces.keeps_creases = false;
        surfaces.keeps_creases = !compete(contest_with(best));
    }
    if (is_open && is_contest) {
        const bool creases = surfaces.keeps_creases;
        for (const uint32_t tiles : creases ? std::span<const uint32_t>(kOthersWithCreases) : kOthers) {
            options.tiles = tiles;
            (void)compete(creases ? Contest{} : contest_with(best));
        }
    }
    if (best.ok()) {
        best.value().report.times = clock.times();
        best.value().report.seconds = clock.seconds();
    }
    return best;
}

}  // namespace gim

#include "encoder/tiles/best_tiles.h"

#include <utility>

#include "encoder/code/rate_target.h"

namespace gim {

namespace {

constexpr uint32_t kUsual = 120;
constexpr uint32_t kOthers[] = {180, 60};  // more for limbs and high rates, fewer for what is nearly a box

}  // namespace

Result<Encoded> best_of_tiles(const EncodeOnce& run, const EncodeOptions& whole, const StageClock& clock,
                              const Observer& observer) {
    if (whole.tiles > 0) return run(whole, {}, observer);
    EncodeOptions options = whole;
    options.tiles = kUsual;
    auto best = run(options, {}, observer);
    if (!is_searched(whole.rate)) return best;
    for (const uint32_t tiles : kOthers) {
        options.tiles = tiles;
        auto other = run(options, contest_with(best), {});
        if (improves(other, best, whole.rate)) best = std::move(other);
    }
    if (best.ok()) {
        best.value().report.times = clock.times();
        best.value().report.seconds = clock.seconds();
    }
    return best;
}

}  // namespace gim

#include "encoder/layout_runs.h"

#include <tbb/parallel_for.h>

#include <utility>
#include <vector>

#include "encoder/base/at_once.h"
#include "encoder/best_size.h"
#include "encoder/code/rate_target.h"
#include "encoder/planes/labels.h"
#include "encoder/squares/choose_cut.h"
#include "encoder/tiles/best_tiles.h"
#include "encoder/within_budget.h"

namespace gim {

LayoutRuns::LayoutRuns(const LayoutEntry& layout, const Prepared& prepared, const EncodeOptions& options,
                       StageClock& clock, const Observer& observer)
    : layout_(layout),
      prepared_(prepared),
      options_(options),
      clock_(clock),
      observer_(observer),
      tileable_(prepared.mesh, prepared.authored) {
    options_.layout = layout.layout;
}

Result<LayoutRuns::Made> LayoutRuns::make(const EncodeOptions& now, const Observer& observer, CutPreferences& cuts,
                                          StageClock& clock) {
    GIM_CHECK(check_labels(prepared_.original.input, layout()));
    EncodeReport report = prepared_.report;
    const bool may_grow = now.side == options_.side && now.samples == options_.samples;  // smaller sizes are trials
    GIM_TRY(images, layout_.make({prepared_.mesh, now, clock, observer, report, cuts, tileable_, may_grow}));
    return Made{std::move(images), std::move(report)};
}

std::unique_ptr<FileRun> LayoutRuns::run_of(Made made, const EncodeOptions& now) {
    return std::make_unique<FileRun>(std::move(made.images), prepared_.original, now, clock_, std::move(made.report));
}

Result<LayoutRuns::Started*> LayoutRuns::start(const EncodeOptions& now) {
    Started& started = started_[variant_of(now)];
    if (started.run) return &started;
    if (!started.made) {
        GIM_TRY(made, make(now, std::exchange(observer_, {}), cuts_, clock_));
        started.made = std::move(made);
    }
    started.run = run_of(std::move(*started.made), now);
    started.made.reset();
    return &started;
}

void LayoutRuns::make_quietly(const Waiting& waiting) {
    Started& started = *waiting.started;
    if (started.made || started.run) return;
    StageClock quiet({});
    CutPreferences cuts = cuts_;
    auto made = make(*waiting.options, {}, cuts, quiet);
    if (made.ok()) started.made = std::move(made.value());
}

std::vector<LayoutRuns::Waiting> LayoutRuns::waiting_for(const std::vector<EncodeOptions>& all) {
    std::vector<Waiting> waiting;
    for (const EncodeOptions& now : all) {
        if (layout() == Layout::kTiles) tileable_.of(now.creases);  // made here, for what follows only reads it
        waiting.push_back({&now, &started_[variant_of(now)]});
    }
    return waiting;
}

void LayoutRuns::make_ahead() {
    const bool are_tiles = layout() == Layout::kTiles;
    if (observer_ || (!are_tiles && may_choose_cut(options_))) return;
    const std::vector<EncodeOptions> all = are_tiles ? likely_tiles(options_, tileable_.has_creases())
                                                     : std::vector<EncodeOptions>{size_variants(options_).front()};
    const std::vector<Waiting> waiting = waiting_for(all);
    tbb::parallel_for(size_t{0}, all.size(), [&](size_t i) { make_quietly(waiting[i]); });
}

void LayoutRuns::make_all_ahead(const std::vector<EncodeOptions>& all) {
    const std::vector<Waiting> waiting = waiting_for(all);
    clock_.begin(Stage::kParametrize);
    for_each_at_once(all.size(), clock_, [&](size_t i) { make_quietly(waiting[i]); });
}

Result<Estimate> LayoutRuns::estimate_of(const EncodeOptions& now, std::optional<double> near) {
    GIM_TRY(started, start(now));
    if (!started->estimate) {
        GIM_TRY(estimate, started->run->estimate(near ? near : near_));
        started->estimate = estimate;
    }
    return *started->estimate;
}

// The usual cut often costs a few percent more than the best of several, for a sixth of their time.
Result<Estimate> LayoutRuns::estimate_without_choice(const EncodeOptions& now) {
    if (!may_choose_cut(now)) return estimate_of(now, {});
    CutPreferences cuts = usual_cuts(prepared_.mesh);
    GIM_TRY(made, make(now, {}, cuts, clock_));
    return run_of(std::move(made), now)->estimate({});
}

Result<Estimate> LayoutRuns::first_estimate() {
    if (layout() != Layout::kTiles) return estimate_without_choice(size_variants(options_).front());
    GIM_TRY(tried, try_usual_tiles(runs({}), options_, tileable_.has_creases()));
    return tried[0].estimate;
}

Result<Estimate> LayoutRuns::estimate() {
    if (layout() == Layout::kTiles) {
        GIM_TRY(tried, try_tiles(runs({}), options_, tileable_.has_creases()));
        return tried[0].estimate;
    }
    Result<Estimate> best = Error{};
    for (const EncodeOptions& variant : size_variants(options_)) {
        const auto now = estimate_of(variant, {});
        const bool is_better = now.ok() && (!best.ok() || now.value().log_bytes < best.value().log_bytes);
        if (is_better || !(now.ok() || best.ok())) best = now;
    }
    return best;
}

CodingRuns LayoutRuns::runs(const Contest& contest) {
    const auto code = [this, contest](const EncodeOptions& variant, const Contest& among) -> Result<Encoded> {
        GIM_TRY(started, start(variant));
        auto encoded = started->run->finish(joined(among, contest));
        started_.erase(variant_of(variant));
        return encoded;
    };
    const auto estimate = [this](const EncodeOptions& variant, std::optional<double> near) {
        return estimate_of(variant, near);
    };
    const auto make_ahead = [this](const std::vector<EncodeOptions>& all) { make_all_ahead(all); };
    return {code, estimate, make_ahead};
}

Result<Encoded> LayoutRuns::best_of_variants(const EncodeOptions& now, const Contest& contest) {
    return layout() == Layout::kTiles
               ? best_of_tiles(runs(contest), now, tileable_.has_creases(), contest.is_target_rough)
               : best_of_sizes(runs(contest), now);
}

Result<Encoded> LayoutRuns::best(const Contest& contest) {
    auto encoded = within_budget(options_, [&](const EncodeOptions& now) {
        if (now.rate.value != options_.rate.value) {
            started_.clear();
            cuts_ = {};
        }
        return best_of_variants(now, contest);
    });
    started_.clear();
    return encoded;
}

}  // namespace gim

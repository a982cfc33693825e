#include "encoder/race_layouts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/base/at_once.h"
#include "encoder/code/rate_target.h"
#include "encoder/fit/effort.h"
#include "encoder/layout/encode_once.h"
#include "encoder/layouts.h"

namespace gim {

namespace {

// By how much of its bytes the first variant of a layout may seem larger than that of another one, and its others are
// tried all the same.
constexpr double kFirstExcess = 0.25;
// By how much of its bytes a brief fit may seem larger than the file of another layout, and is coded all the same. Brief
// fits take 11 to 17 % more bytes than full ones, so a layout that would gain less than 1 % is left out.
constexpr double kBriefExcess = 0.12;

// By how much of its bytes the brief fit of a layout may seem larger than that of the cheapest one, and it is coded all the
// same.
constexpr double kBriefNoise = 0.02;

// Images of larger surfaces are made one after the other: they take gigabytes.
constexpr size_t kMostFacesAtOnce = 2000000;

double cost_of(const Encoded& encoded) { return log_bytes(double(encoded.bytes.size()), encoded.report.error.psnr); }

// The highest cost of brief fits that leaves a chance against a file.
double most_to_beat(const Encoded& rival) { return cost_of(rival) + std::log1p(kBriefExcess); }

bool may_race(const LayoutEntry& entry, const EncodeOptions& options) {
    return entry.races && (entry.layout == Layout::kGim || effort_of(options).races);
}

class Race {
  public:
    Race(const Prepared& prepared, const EncodeOptions& options, StageClock& clock, const Observer& observer)
        : options_(options), clock_(clock), is_small_(prepared.mesh.triangles.size() <= kMostFacesAtOnce) {
        for (const LayoutEntry& entry : all_layouts()) {
            if (may_race(entry, options))
                waiting_.push_back(std::make_unique<LayoutRuns>(entry, prepared, options, clock, observer));
        }
    }

    Result<Encoded> run() {
        if (!is_searched(options_.rate)) set_the_pace();
        line_up();
        for (Racer& racer : racers_) {
            if (has_chance(racer)) {
                auto encoded = racer.runs->best(contest());
                const bool has_cost = note_cost(encoded);
                take(std::move(encoded));
                if (has_cost) continue;
            }
            note_estimate(racer);
        }
        if (best_->ok()) complete(best_->value().report);
        return std::move(*best_);
    }

  private:
    struct Racer {
        std::unique_ptr<LayoutRuns> runs;
        std::optional<double> log_bytes;  // of brief fits; nothing if they are not known
    };

    // The first layout that can make images has the quality that is asked for. The others must reach the PSNR of its brief
    // fit, by brief fits too.
    void set_the_pace() {
        if (waiting_.size() < 2) return;
        if (is_small_) {
            clock_.begin(Stage::kParametrize);
            for_each_at_once(waiting_.size(), clock_, [&](size_t i) { waiting_[i]->make_ahead(); });
        }
        double near = 0;
        while (racers_.empty() && !waiting_.empty()) {
            const auto estimate = waiting_.front()->estimate();
            if (estimate.ok()) {
                racers_.push_back({std::move(waiting_.front()), estimate.value().log_bytes});
                is_target_rough_ = true;
                options_.rate = {RateTarget::Kind::kPsnr, estimate.value().psnr};
                near = estimate.value().quantizer;
            } else {
                take(estimate.error());
            }
            waiting_.erase(waiting_.begin());
        }
        if (is_target_rough_)
            for (const auto& runs : waiting_) runs->aim(options_.rate, near);
    }

    // Where brief fits also decided about the target, those alone tell who is coded, and only the file of who is nearly as
    // cheap may still be the best one.
    bool has_chance(const Racer& racer) const {
        if (!best_ || !best_->ok() || !racer.log_bytes) return true;
        if (is_target_rough_) return *racer.log_bytes < cost(racers_.front()) + std::log1p(kBriefNoise);
        return *racer.log_bytes < most_to_beat(best_->value());
    }

    Contest contest() const {
        if (is_target_rough_) return {0, false, true};
        return best_ && best_->ok() ? contest_with(*best_) : Contest{};
    }

    // Estimates what each layout costs, the cheapest first.
    void line_up() {
        const bool is_alone = waiting_.size() + racers_.size() == 1 && !best_;
        for (auto& runs : waiting_) {
            racers_.push_back({std::move(runs), {}});
            if (!is_alone) note(racers_.back(), racers_.back().runs->first_estimate());
        }
        sort_by_cost();
        double least = racers_.empty() ? HUGE_VAL : cost(racers_.front());
        if (best_ && best_->ok()) least = std::min(least, most_to_beat(best_->value()));
        for (Racer& racer : racers_) {
            const bool is_behind = racer.log_bytes && *racer.log_bytes > least + std::log1p(kFirstExcess);
            if (is_alone || is_behind) continue;
            const auto estimate = racer.runs->estimate();
            note(racer, estimate);
            least = std::min(least, cost(racer));
            if (!lacks_images(estimate)) continue;
            take(estimate.error());
            racer.runs.reset();
        }
        std::erase_if(racers_, [](const Racer& racer) { return !racer.runs; });
        sort_by_cost();
    }

    static double cost(const Racer& racer) { return racer.log_bytes.value_or(HUGE_VAL); }
    static void note(Racer& racer, const Result<Estimate>& estimate) {
        if (estimate.ok()) racer.log_bytes = estimate.value().log_bytes;
    }
    void sort_by_cost() {
        std::stable_sort(racers_.begin(), racers_.end(),
                         [](const Racer& a, const Racer& b) { return cost(a) < cost(b); });
    }

    void take(Result<Encoded> encoded) {
        if (!best_ || is_better(encoded, *best_)) best_.emplace(std::move(encoded));
    }

    bool is_better(const Result<Encoded>& now, const Result<Encoded>& best) const {
        if (!is_target_rough_ || !now.ok() || !best.ok()) return improves(now, best, options_.rate);
        return cost_of(now.value()) < cost_of(best.value());
    }

    bool note_cost(const Result<Encoded>& encoded) {
        if (!encoded.ok()) return false;
        const EncodeReport& report = encoded.value().report;
        costs_.push_back({report.layout, double(report.file_bytes), report.error.psnr, false});
        return true;
    }

    void note_estimate(const Racer& racer) {
        if (!racer.log_bytes) return;
        const double bytes = bytes_at(options_.rate, *racer.log_bytes);
        costs_.push_back({racer.runs->layout(), bytes, psnr_at(bytes, *racer.log_bytes), true});
    }

    // The report of the winner.
    void complete(EncodeReport& report) const {
        std::copy_if(costs_.begin(), costs_.end(), std::back_inserter(report.others),
                     [&](const LayoutCost& cost) { return cost.layout != report.layout; });
    }

    EncodeOptions options_;
    StageClock& clock_;
    const bool is_small_;
    std::vector<std::unique_ptr<LayoutRuns>> waiting_;
    std::vector<Racer> racers_;
    std::vector<LayoutCost> costs_;
    std::optional<Result<Encoded>> best_;  // or the first error
    bool is_target_rough_ = false;
};

}  // namespace

Result<Encoded> race_layouts(const Prepared& prepared, const EncodeOptions& options, StageClock& clock,
                             const Observer& observer) {
    auto best = Race(prepared, options, clock, observer).run();
    for (const LayoutEntry& entry : all_layouts()) {
        if (may_race(entry, options) || !lacks_images(best)) continue;
        auto other = LayoutRuns(entry, prepared, options, clock, observer).best({});
        if (other.ok()) return other;
    }
    return best;
}

}  // namespace gim

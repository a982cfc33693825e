// Times the stages of a run and reports its progress to the caller.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "encoder/base/cancelled.h"
#include "gim/encoder.h"

namespace gim {

class StageClock {
  public:
    explicit StageClock(Progress progress) : progress_(std::move(progress)) {}

    // Ends the running stage and begins the next. If a stage runs several times, its times add up.
    void begin(Stage stage) {
        end();
        running_ = true;
        stage_ = stage;
        since_ = Clock::now();
        report(0);
    }
    void end() {
        if (!running_) return;
        running_ = false;
        const double seconds = std::chrono::duration<double>(Clock::now() - since_).count();
        const std::string name(stage_name(stage_));
        const auto known =
            std::find_if(times_.begin(), times_.end(), [&](const StageTime& t) { return t.stage == name; });
        if (known == times_.end()) {
            times_.push_back({name, seconds});
        } else {
            known->seconds += seconds;
        }
    }
    // Throws Cancelled if the caller wants to stop.
    void report(double fraction) const {
        if (progress_ && !progress_(stage_, fraction)) throw Cancelled{stage_};
    }
    // Returns a callback for stages that report their own progress. They need not look at what it returns.
    Progress progress() const {
        return [this](Stage, double fraction) {
            report(fraction);
            return true;
        };
    }
    const std::vector<StageTime>& times() const { return times_; }
    double seconds() const {
        double sum = 0;
        for (const StageTime& time : times_) sum += time.seconds;
        return sum;
    }

  private:
    using Clock = std::chrono::steady_clock;
    Progress progress_;
    std::vector<StageTime> times_;
    Stage stage_ = Stage::kInput;
    Clock::time_point since_;
    bool running_ = false;
};

}  // namespace gim

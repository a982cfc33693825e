#include "tools/progress.h"

#include <unistd.h>

#include <cstdio>

namespace gim {
namespace {

constexpr std::chrono::milliseconds kPause(100);  // between two updates of one stage
constexpr int kLeftWidth = 20;                    // columns of the time that is left

double seconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }

}  // namespace

ProgressPrinter::ProgressPrinter(bool quiet) : visible_(!quiet && ::isatty(STDERR_FILENO) == 1) {}

ProgressPrinter::~ProgressPrinter() { finish_stage(); }

void ProgressPrinter::finish_stage() {
    if (visible_ && stage_) {
        const std::string name(stage_name(*stage_));
        std::fprintf(stderr, "\r  %-14s %7.2f s%*s\n", name.c_str(), seconds(Clock::now() - begin_), kLeftWidth, "");
    }
    stage_.reset();
}

void ProgressPrinter::begin_part(const std::string& title) {
    finish_stage();
    if (visible_) std::fprintf(stderr, "%s\n", title.c_str());
}

void ProgressPrinter::update(Stage stage, double fraction) {
    if (!visible_) return;
    const Clock::time_point now = Clock::now();
    const bool is_new = stage_ != stage;
    if (is_new) {
        finish_stage();
        stage_ = stage;
        begin_ = now;
        left_ = {};
    }
    const std::optional<double> left = left_.update(fraction, seconds(now.time_since_epoch()));
    if (!is_new && now - printed_ < kPause) return;
    printed_ = now;
    const std::string name(stage_name(stage)), rest = left ? duration_text(*left) + " left" : "";
    std::fprintf(stderr, "\r  %-14s %5.0f %%   %-*s", name.c_str(), 100 * fraction, kLeftWidth, rest.c_str());
    std::fflush(stderr);
}

Progress ProgressPrinter::callback() {
    if (!visible_) return {};
    return [this](Stage stage, double fraction) {
        update(stage, fraction);
        return true;
    };
}

}  // namespace gim

#include "encoder/search_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "encoder/code/rate_target.h"
#include "encoder/least_file.h"

namespace gim {

namespace {

using Bytes = std::vector<uint8_t>;
using Values = RateSearchValues;

std::string decimal(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

Result<Bytes> search_psnr(const FileWriter& writer, double start, double target, const JudgeFile& judge) {
    double fine = Values::kFinest - 1,
           coarse = Values::kCoarsest + 1;  // coarsest that is good enough, finest that is not; base-2 logarithms
    double fine_psnr = 0, coarse_psnr = 0, best_psnr = 0;
    Bytes best;
    double at = std::clamp(start, Values::kFinest, Values::kCoarsest);
    for (int i = 0; i < Values::kMostFiles; ++i) {
        Bytes bytes = writer.write(std::exp2(at));
        GIM_TRY(psnr, judge(bytes));
        best_psnr = std::max(best_psnr, psnr);
        if (psnr >= target) {
            // A repair of folds is a leap. So the coarsest file need not be the smallest.
            if (best.empty() || bytes.size() < best.size()) best = std::move(bytes);
            fine = at, fine_psnr = psnr;
            if (psnr <= target + Values::kPsnrSlack || at >= Values::kCoarsest) break;
        } else {
            coarse = at, coarse_psnr = psnr;
            if (at <= Values::kFinest) break;
        }
        const bool bracketed = fine >= Values::kFinest && coarse <= Values::kCoarsest;
        if (bracketed && coarse - fine < 1e-3) break;
        if (bracketed) {
            // Aims a little above the target, and not too near to either end.
            const double aim = target + 0.4 * Values::kPsnrSlack;
            const double part = std::clamp((fine_psnr - aim) / (fine_psnr - coarse_psnr), 0.1, 0.9);
            at = fine + part * (coarse - fine);
        } else {
            const double step = (psnr - target) / Values::kPlainDecibelPerOctave;
            at = std::clamp(at + (step >= 0 ? std::max(step, 0.05) : std::min(1.3 * step, -0.1)), Values::kFinest,
                            Values::kCoarsest);
        }
    }
    if (best.empty()) {
        return Error{Stage::kCode, decimal(target) + " dB is out of reach: the samples themselves reach " +
                                       decimal(best_psnr) + " dB; take a larger --size, or ask for less"};
    }
    return best;
}

// The quantizers around a budget of bytes, as base-2 logarithms. An excess is octaves_to() the bytes aimed at.
class BudgetBracket {
  public:
    void add_too_large(double octave, double excess) { fine_ = {octave, excess}; }
    void add_small(double octave, double excess) { coarse_ = {octave, excess}; }

    bool is_narrow() const { return fine_ && coarse_ && coarse_->octave - fine_->octave < 1e-4; }

    // Returns the quantizer to try after the last one. Sizes leap, so every second file halves the bracket.
    double next() {
        halves_ = !halves_;
        if (!fine_ || !coarse_) return std::clamp(outwards(), Values::kFinest, Values::kCoarsest);
        const bool halves = halves_ || !(fine_->excess > coarse_->excess);
        const double part = halves ? 0.5 : std::clamp(fine_->excess / (fine_->excess - coarse_->excess), 0.1, 0.9);
        return fine_->octave + part * (coarse_->octave - fine_->octave);
    }

  private:
    struct Tried {
        double octave, excess;
    };

    // Goes on towards the budget: as far as the excess asks for, but farther where that was not enough before.
    double outwards() {
        const Tried& last = fine_ ? *fine_ : *coarse_;
        const double step = std::clamp(1.2 * std::abs(last.excess), least_step_, 2.0);
        least_step_ = std::min(2 * least_step_, 2.0);
        return last.octave + (fine_ ? step : -step);
    }

    std::optional<Tried> fine_, coarse_;  // the coarsest that is too large, the finest that is not
    double least_step_ = 0.25;
    bool halves_ = true;
};

Result<Bytes> search_bytes(const FileWriter& writer, double start, double budget) {
    const RateTarget aim{RateTarget::Kind::kBytes, (1 - 0.4 * Values::kBytesSlack) * budget};
    BudgetBracket bracket;
    Bytes best;
    double at = std::clamp(start, Values::kFinest, Values::kCoarsest);
    for (int i = 0; i < 2 * Values::kMostFiles; ++i) {
        Bytes bytes = writer.write(std::exp2(at));
        const auto size = static_cast<double>(bytes.size());
        const double excess = octaves_to(aim, size, 0);
        if (size <= budget) {
            bracket.add_small(at, excess);
            GIM_TRY(is_surface, has_area(bytes));
            if (is_surface) best = std::move(bytes);
            if (size >= (1 - Values::kBytesSlack) * budget || at <= Values::kFinest) break;
        } else {
            bracket.add_too_large(at, excess);
            if (at >= Values::kCoarsest) break;
        }
        if (bracket.is_narrow()) break;
        at = bracket.next();
    }
    return best;
}

}  // namespace

Result<Bytes> code_to_target(const FileWriter& writer, double first, const RateTarget& target, const JudgeFile& judge) {
    switch (target.kind) {
        case RateTarget::Kind::kLossless:
        case RateTarget::Kind::kQuality:
            return writer.write(first);
        case RateTarget::Kind::kPsnr:
            return search_psnr(writer, std::log2(first), target.value, judge);
        case RateTarget::Kind::kBytes:
            return search_bytes(writer, std::log2(first), target.value);
        case RateTarget::Kind::kMaxError:
            break;  // rate_search.cpp
    }
    return Error{Stage::kCode, "unknown rate target"};
}

}  // namespace gim

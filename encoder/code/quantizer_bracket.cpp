#include "encoder/code/quantizer_bracket.h"

#include <algorithm>
#include <cmath>

#include "encoder/code/rate_target.h"

namespace gim {

using Values = RateSearchValues;

void QuantizerBracket::add(double quantizer, double margin) {
    const Tried now{std::log2(quantizer), std::clamp(margin, -Values::kMostMargin, Values::kMostMargin)};
    std::optional<Tried>& same = margin >= 0 ? met_ : missed_;
    const bool is_first = !met_ && !missed_;
    if (margin < 0) {
        const bool is_hopeless = now.margin <= -Values::kMostMargin;  // but finer ones may do
        const bool gains = is_first || is_hopeless || now.margin >= best_miss_ + Values::kLeastGain;
        idle_ = gains ? 0 : idle_ + 1;
        best_miss_ = is_first ? now.margin : std::max(best_miss_, now.margin);
    }
    same_ = same ? same_ + 1 : 1;
    same = now;
}

std::optional<double> QuantizerBracket::next() const {
    const std::optional<double> octave = met_ && missed_ ? between() : met_ ? coarser() : finer();
    if (!octave) return {};
    return std::exp2(*octave);
}

std::optional<double> QuantizerBracket::between() const {
    const double width = missed_->octave - met_->octave;
    const double part = met_->margin / (met_->margin - missed_->margin);
    // Where the samples limit the distance, the margin is small at every quantizer. So it counts only in a narrow bracket.
    const bool gains_little = width <= Values::kNearEnough && part * width < Values::kNarrowBracket;
    if (width < Values::kNarrowBracket || gains_little) return {};
    return met_->octave + std::clamp(part, 0.25, 0.75) * width;
}

std::optional<double> QuantizerBracket::coarser() const {
    if (met_->octave >= Values::kCoarsest) return {};
    return std::min(met_->octave + step(met_->margin), Values::kCoarsest);
}

std::optional<double> QuantizerBracket::finer() const {
    if (missed_->octave <= Values::kFinest || idle_ >= Values::kMostIdle) return {};
    return std::max(missed_->octave - step(-missed_->margin), Values::kFinest);
}

// Grows while the target stays on one side.
double QuantizerBracket::step(double margin) const {
    const double least = std::min(Values::kNear * std::exp2(same_ - 1), Values::kMostErrorStep);
    return std::clamp(margin / decibel_per_octave_, least, Values::kMostErrorStep);
}

}  // namespace gim

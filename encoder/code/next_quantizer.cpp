#include "encoder/code/next_quantizer.h"

#include <algorithm>
#include <cmath>

#include "encoder/code/rate_target.h"

namespace gim {

namespace {

// Fits scatter by about this much. So nearer quantizers do not tell a slope, and flat or steep ones are not believed.
constexpr double kScatter = 0.05;  // octaves
constexpr double kFlattest = 0.4, kSteepest = 2;

}  // namespace

double NextQuantizer::after(double quantizer, double room) {
    const Tried now{std::log2(quantizer), room};
    slope_.reset();
    if (last_ && std::abs(now.octave - last_->octave) >= kScatter)
        slope_ = (last_->room - now.room) / (now.octave - last_->octave);
    const bool is_between = last_ && last_->room * room < 0;  // any slope is safe there
    last_ = now;
    const double slope = slope_.value_or(1);
    const bool is_believed = is_between && slope > 0;
    return coarser_quantizer(quantizer, room / (is_believed ? slope : std::clamp(slope, kFlattest, kSteepest)),
                             most_step_);
}

}  // namespace gim

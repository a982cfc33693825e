// Which fit an encoding asks for.
#pragma once

#include <optional>

#include "encoder/fit/fit.h"
#include "gim/encoder.h"

namespace gim {

// A loose fit multiplies the tangential detail: only what is coded without loss can afford it. Nothing: no fit.
inline std::optional<FitOptions::Strength> fit_strength(const EncodeOptions& options) {
    switch (options.fit) {
        case FitStrength::kOff:
            return std::nullopt;
        case FitStrength::kStiff:
            return FitOptions::Strength::kStiff;
        case FitStrength::kLoose:
            return FitOptions::Strength::kLoose;
        case FitStrength::kAuto:
            break;
    }
    return options.rate.kind == RateTarget::Kind::kLossless ? FitOptions::Strength::kLoose
                                                            : FitOptions::Strength::kStiff;
}

}  // namespace gim

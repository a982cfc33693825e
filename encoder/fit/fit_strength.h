// The fit that the options ask for.
#pragma once

#include <optional>

#include "encoder/fit/fit.h"
#include "gim/encoder.h"

namespace gim {

// Returns nothing if no fit is wanted. Only lossless coding can afford a loose fit, which multiplies tangential detail.
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

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

// Whether the images of a file are fitted to the codec and its quantizer (fit_coded.h).
inline bool is_fitted_to_codec(const EncodeOptions& options) {
    return options.fit == FitStrength::kAuto && options.rate.kind != RateTarget::Kind::kLossless;
}

// The fit of an image as it is sampled. Returns nothing if no fit is wanted.
inline std::optional<FitOptions> first_fit(const EncodeOptions& options) {
    const auto strength = fit_strength(options);
    if (!strength) return std::nullopt;
    FitOptions fit;
    fit.strength = *strength;
    fit.seed = options.seed;
    fit.threads = options.threads;
    return fit;
}

}  // namespace gim

#include "encoder/code/rate_target.h"

#include <algorithm>
#include <cmath>

namespace gim {

namespace {

using Values = RateSearchValues;

const double kLogBytesPerDecibel = std::log(Values::kBytesPerOctave) / Values::kDecibelPerOctave;

double quality_quantizer(double quality, uint32_t bits) { return 8 * std::exp2((75 - quality) / 10 + int(bits) - 12); }

// Clamps to the range that searches cover.
double clamped_quantizer(double quantizer) {
    return std::clamp(quantizer, std::exp2(Values::kFinest), std::exp2(Values::kCoarsest));
}

// The PSNR that files of the target have: exactly, or usually.
double psnr_of(const RateTarget& target) {
    return target.kind == RateTarget::Kind::kMaxError ? Values::kRmsBelowMaximum - 20 * std::log10(target.value)
                                                      : target.value;
}

}  // namespace

RateTarget resolved_target(const RateTarget& target, double diagonal) {
    if (target.kind != RateTarget::Kind::kMaxError || target.in_diagonals) return target;
    constexpr double kRounding = 1e-12;  // so that the quotient never allows more
    return {target.kind, target.value / diagonal * (1 - kRounding), true};
}

bool is_searched(const RateTarget& target) {
    return target.kind != RateTarget::Kind::kLossless && target.kind != RateTarget::Kind::kQuality;
}

double octaves_to(const RateTarget& target, double bytes, double psnr) {
    return target.kind == RateTarget::Kind::kBytes ? std::log(bytes / target.value) / std::log(Values::kBytesPerOctave)
                                                   : (psnr - psnr_of(target)) / Values::kDecibelPerOctave;
}

double log_bytes(double bytes, double psnr) { return std::log(bytes) - psnr * kLogBytesPerDecibel; }

double bytes_at(const RateTarget& target, double log_bytes) {
    return target.kind == RateTarget::Kind::kBytes ? target.value
                                                   : std::exp(log_bytes + psnr_of(target) * kLogBytesPerDecibel);
}

double psnr_at(double bytes, double log_bytes) { return (std::log(bytes) - log_bytes) / kLogBytesPerDecibel; }

double coarser_quantizer(double quantizer, double octaves, double most) {
    return clamped_quantizer(quantizer * std::exp2(std::clamp(octaves, -most, most)));
}

// Scanned surfaces have about 68 dB at 16 steps of a 12-bit quantizer.
double first_quantizer(const RateTarget& target, uint32_t bits) {
    const double of_12_bits = std::exp2(int(bits) - 12);
    if (target.kind == RateTarget::Kind::kPsnr || target.kind == RateTarget::Kind::kMaxError)
        return clamped_quantizer(16 * of_12_bits * std::exp2((68 - psnr_of(target)) / Values::kDecibelPerOctave));
    return clamped_quantizer(quality_quantizer(target.kind == RateTarget::Kind::kQuality ? target.value : 75, bits));
}

}  // namespace gim

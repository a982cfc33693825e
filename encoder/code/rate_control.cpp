#include "encoder/code/rate_control.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "encoder/base/result.h"

namespace gim {

namespace {

using Bytes = std::vector<uint8_t>;

// Quantizers are searched as their base-2 logarithm, between these.
constexpr double kFinest = -6, kCoarsest = 18;
constexpr int kMostFiles = 16;
constexpr double kPsnrSlack = 0.1;     // dB above the target that are good enough
constexpr double kBytesSlack = 0.005;  // part of the budget that may stay unused

std::string decimal(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

double quality_quantizer(double quality, uint32_t bits) { return 8 * std::exp2((75 - quality) / 10 + int(bits) - 12); }

// About 6 dB per halving without a fit: the first guess after the first measurement, and the safeguard of the secant afterwards.
constexpr double kPlainDecibelPerOctave = 6;

Result<Bytes> search_psnr(const FileWriter& writer, double start, double target, const JudgeFile& judge) {
    double fine = kFinest - 1, coarse = kCoarsest + 1;  // judged good enough / too coarse so far, as logarithms
    double fine_psnr = 0, coarse_psnr = 0, best_psnr = 0;
    Bytes best;
    double at = std::clamp(start, kFinest, kCoarsest);
    for (int i = 0; i < kMostFiles; ++i) {
        Bytes bytes = writer.write(std::exp2(at));
        GIM_TRY(psnr, judge(bytes));
        best_psnr = std::max(best_psnr, psnr);
        if (psnr >= target) {
            best = std::move(bytes);
            fine = at, fine_psnr = psnr;
            if (psnr <= target + kPsnrSlack || at >= kCoarsest) break;
        } else {
            coarse = at, coarse_psnr = psnr;
            if (at <= kFinest) break;
        }
        const bool bracketed = fine >= kFinest && coarse <= kCoarsest;
        if (bracketed && coarse - fine < 1e-3) break;
        if (bracketed) {
            // Aim a little above the target, and never too near to either end.
            const double aim = target + 0.4 * kPsnrSlack;
            const double part = std::clamp((fine_psnr - aim) / (fine_psnr - coarse_psnr), 0.1, 0.9);
            at = fine + part * (coarse - fine);
        } else {
            const double step = (psnr - target) / kPlainDecibelPerOctave;
            at = std::clamp(at + (step >= 0 ? std::max(step, 0.05) : std::min(1.3 * step, -0.1)), kFinest, kCoarsest);
        }
    }
    if (best.empty()) {
        return Error{Stage::kCode, decimal(target) + " dB is out of reach: the samples themselves reach " +
                                       decimal(best_psnr) + " dB; take a larger --size, or ask for less"};
    }
    return best;
}

Result<Bytes> search_bytes(const FileWriter& writer, double start, double budget) {
    double fine = kFinest - 1, coarse = kCoarsest + 1;  // too large / small enough so far, as logarithms
    Bytes best;
    size_t smallest = SIZE_MAX;
    double at = std::clamp(start, kFinest, kCoarsest);
    for (int i = 0; i < 2 * kMostFiles; ++i) {
        Bytes bytes = writer.write(std::exp2(at));
        smallest = std::min(smallest, bytes.size());
        const auto size = static_cast<double>(bytes.size());
        if (size <= budget) {
            coarse = at;
            best = std::move(bytes);
            if (size >= (1 - kBytesSlack) * budget || at <= kFinest) break;
        } else {
            fine = at;
            if (at >= kCoarsest) break;
        }
        const bool bracketed = fine >= kFinest && coarse <= kCoarsest;
        if (bracketed && coarse - fine < 1e-4) break;
        at = bracketed ? 0.5 * (fine + coarse) : std::clamp(at + (size <= budget ? -2.0 : 2.0), kFinest, kCoarsest);
    }
    if (best.empty()) {
        return Error{Stage::kCode, std::to_string(static_cast<uint64_t>(budget)) +
                                       " bytes are too few: the smallest file of this size of image has " +
                                       std::to_string(smallest) + "; take a smaller --size, or allow more"};
    }
    return best;
}

// Into the range that searches cover.
double clamped_quantizer(double quantizer) { return std::clamp(quantizer, std::exp2(kFinest), std::exp2(kCoarsest)); }

}  // namespace

bool is_searched(const RateTarget& target) {
    return target.kind == RateTarget::Kind::kPsnr || target.kind == RateTarget::Kind::kBytes;
}

double octaves_to(const RateTarget& target, double bytes, double psnr) {
    return target.kind == RateTarget::Kind::kBytes ? std::log(bytes / target.value) / std::log(kBytesPerOctave)
                                                   : (psnr - target.value) / kDecibelPerOctave;
}

double coarser_quantizer(double quantizer, double octaves, double most) {
    return clamped_quantizer(quantizer * std::exp2(std::clamp(octaves, -most, most)));
}

// PSNR and size targets begin where scanned surfaces end up: 68 dB at 16 steps of a 12-bit quantizer, 4.3 dB an octave.
double first_quantizer(const RateTarget& target, uint32_t bits) {
    const double of_12_bits = std::exp2(int(bits) - 12);
    if (target.kind == RateTarget::Kind::kPsnr)
        return clamped_quantizer(16 * of_12_bits * std::exp2((68 - target.value) / kDecibelPerOctave));
    return clamped_quantizer(quality_quantizer(target.kind == RateTarget::Kind::kQuality ? target.value : 75, bits));
}

Result<Bytes> code_to_target(const FileWriter& writer, double first, const RateTarget& target, const JudgeFile& judge) {
    switch (target.kind) {
        case RateTarget::Kind::kLossless:
        case RateTarget::Kind::kQuality:
            return writer.write(first);
        case RateTarget::Kind::kPsnr:
            return search_psnr(writer, std::log2(first), target.value, judge);
        case RateTarget::Kind::kBytes:
            return search_bytes(writer, std::log2(first), target.value);
    }
    return Error{Stage::kCode, "unknown rate target"};
}

}  // namespace gim

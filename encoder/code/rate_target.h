// Rate targets as quantizers, and every constant of the search for them.
#pragma once

#include <cstdint>

#include "gim/encoder.h"

namespace gim {

// Values of the search, side by side. Slacks tell how far above a target is good enough.
struct RateSearchValues {
    // Quantizers, as base-2 logarithms.
    static constexpr double kFinest = -6, kCoarsest = 18;
    // What an octave of the quantizer changes, about: in files that are fitted to it (fit/fit_coded.h), and in others.
    static constexpr double kDecibelPerOctave = 4.3, kBytesPerOctave = 1.65, kPlainDecibelPerOctave = 6;

    // Files of one set of samples.
    static constexpr double kPsnrSlack = 0.1;     // dB
    static constexpr double kBytesSlack = 0.005;  // of the budget
    static constexpr int kMostFiles = 16;         // twice as many for a budget of bytes
    static constexpr int kMostAttempts =
        3;  // that a file of the quick search misses the target when it is measured in full
    static constexpr double kPsnrBeyond = 0.01;  // dB that the next attempt aims above what was missing

    // Files whose samples are fitted to each quantizer.
    static constexpr double kFittedPsnrSlack = 0.12;
    static constexpr double kFittedBytesSlack = 0.01;
    static constexpr int kMostApproaches = 4, kMostFits = 9;
    static constexpr double kNear = 0.25;                       // octaves of the quantizer that a fit can go on over
    static constexpr double kMostStep = 4, kMostFinalStep = 2;  // octaves from one file to the next

    // Trial codings that choose a cut.
    static constexpr int kMostGuesses = 3;
    static constexpr double kNearEnough = 0.5;  // octaves

    // Targets up to here are tried on squares of half the side too: there it was better on some of the models that were
    // measured (spec/experiments.md).
    static constexpr double kMostPsnrOfSmallerSides = 71;
    static constexpr uint32_t kLeastSideToHalve = 65;

    // Samples of a comparison each way; the decision about a target takes as many as compare() does.
    static constexpr uint32_t kSearchSamples = 120000, kTrialSamples = 60000;
};

// Is the quantizer searched for? Else the target says what it is.
bool is_searched(const RateTarget& target);

// How much coarser, in octaves, the quantizer of a fitted file of that size and error might be for a target of bytes or PSNR.
double octaves_to(const RateTarget& target, double bytes, double psnr);

// A quantizer so many octaves coarser, at most `most` either way, in the range that searches cover.
double coarser_quantizer(double quantizer, double octaves, double most);

// The quantizer of a quality: 75 is a step of 8 quantization steps of a 12-bit quantizer, 10 more halve it. For a PSNR: where
// scanned surfaces end up. Else that of quality 75.
double first_quantizer(const RateTarget& target, uint32_t bits);

}  // namespace gim

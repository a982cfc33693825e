// Turns rate targets into quantizers. Holds every constant of the rate search.
#pragma once

#include <cstdint>

#include "gim/encoder.h"

namespace gim {

// Constants of the search. A slack tells how much better than the target, or smaller than the budget, is good enough.
struct RateSearchValues {
    // Quantizers, as base-2 logarithms.
    static constexpr double kFinest = -6, kCoarsest = 18;
    // Approximate change per octave of the quantizer: in files fitted to it (fit/fit_coded.h), and in others.
    static constexpr double kDecibelPerOctave = 4.3, kBytesPerOctave = 1.65, kPlainDecibelPerOctave = 6;

    // Searches that keep the samples.
    static constexpr double kPsnrSlack = 0.1;     // dB
    static constexpr double kBytesSlack = 0.005;  // of the budget
    static constexpr int kMostFiles = 16;         // twice as many for a budget of bytes
    // Times a quick search is repeated because its file misses the target when measured in full.
    static constexpr int kMostAttempts = 3;
    static constexpr double kPsnrBeyond = 0.01;  // dB that a repeated search adds to the missing dB

    // Searches that fit the samples to each quantizer.
    static constexpr double kFittedPsnrSlack = 0.08;
    static constexpr double kFittedBytesSlack = 0.01;
    static constexpr int kMostApproaches = 4, kMostFits = 9;
    static constexpr double kNear = 0.25;  // octaves of the quantizer over which a fit can continue
    static constexpr double kMostStep = 4, kMostFinalStep = 2;  // octaves from one file to the next

    // Searches on one side of the square that compete with other sides (contest.h). By how much of the rival's bytes a
    // file may seem larger, after a quick fit and after a full one. Quick fits take 5 to 10 % more bytes.
    static constexpr double kQuickExcess = 0.15, kFinalExcess = 0.04;
    // Where finer quantizers gain so little and so much is missing, the samples are too few. Slope: of 1; room: octaves.
    static constexpr double kHopelessSlope = 0.35, kHopelessRoom = 0.1;

    // Searches for a largest distance, with fitted samples and with others. A margin is by how many dB the distance is
    // below the target's.
    static constexpr int kMostErrorFits = 12, kMostErrorFiles = 32;
    static constexpr double kMostErrorStep = 1.5;   // octaves; long steps could miss the quantizers that are in reach
    static constexpr double kNarrowBracket = 0.04;  // octaves; 2 % of the bytes
    static constexpr double kLeastGain = 0.3;       // dB; the distance goes up and down by about 1 dB
    static constexpr int kMostIdle = 3;             // finer files without that gain
    static constexpr double kMostMargin = 400;      // dB; bounds the logarithm of a distance of 0
    // Approximate PSNR minus 20 log10(diagonal / largest distance).
    static constexpr double kRmsBelowMaximum = 18;

    // Trial codings that choose a cut.
    static constexpr int kMostGuesses = 3;
    static constexpr double kNearEnough = 0.5;  // octaves

    // Targets up to this PSNR, and from this largest distance on, also try squares of half the side: better on some
    // models (spec/experiments.md).
    static constexpr double kMostPsnrOfSmallerSides = 71;
    static constexpr double kLeastErrorOfSmallerSides = 0.004;  // diagonals; 129 x 129 samples often reach no less
    static constexpr uint32_t kLeastSideToHalve = 65;

    // Samples of a comparison, each way. The final decision about a target takes as many as compare().
    static constexpr uint32_t kSearchSamples = 120000, kTrialSamples = 60000;
    // More dB than the PSNR of kSearchSamples is off.
    static constexpr double kPsnrOfFewSamples = 0.2;
};

// A budget of bytes below all that a caller may name. Stands for the smallest file in reach.
inline constexpr double kFewestBytes = 0.5;

// Returns true if the target needs a search for the quantizer, false if the target determines it.
bool is_searched(const RateTarget& target);

// Returns the target with a largest error in diagonals of the input's bounding box. All functions below take it so.
RateTarget resolved_target(const RateTarget& target, double diagonal);

// Estimates by how many octaves the quantizer of a fitted file could be coarser to meet the target. bytes, psnr: of that
// file. The largest error is estimated by the PSNR, because that of a single file is noise.
double octaves_to(const RateTarget& target, double bytes, double psnr);

// What a brief fit says about a search.
struct Estimate {
    double log_bytes = 0;  // the cost of the file
    double quantizer = 0;  // about the one that meets the target
    double psnr = 0;       // of the brief fit
};

// The cost of a file in one number: the natural logarithm of its bytes, converted to the same PSNR for all files of a
// surface, up to a constant. Less is better.
double log_bytes(double bytes, double psnr);
// Estimates the bytes at the target, and the PSNR at a budget of bytes, of a file of that cost.
double bytes_at(const RateTarget& target, double log_bytes);
double psnr_at(double bytes, double log_bytes);

// Returns the quantizer made coarser by `octaves`, at most `most` either way, within the range that searches cover.
double coarser_quantizer(double quantizer, double octaves, double most);

// Returns the first quantizer to try.
//   quality  75 is a step of 8 quantization steps of a 12-bit quantizer; 10 more halve it
//   psnr     the one at which scanned surfaces have about this PSNR
//   error    the one of the PSNR that usually comes with it
//   others   that of quality 75
double first_quantizer(const RateTarget& target, uint32_t bits);

}  // namespace gim

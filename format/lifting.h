// The two wavelets as lifting steps on rows, and the quantizer steps of their bands.  spec/gim-format.md, "Wavelets".
// A run of n >= 2 samples splits into its even ones (low) and its odd ones (high). High sample i lies between low
// samples i and i+1. A sample at an end uses its only neighbour twice (symmetric extension). After: Daubechies,
// Sweldens. Factoring Wavelet Transforms into Lifting Steps. 1998 (9/7); Calderbank, Daubechies, Sweldens, Yeo. Wavelet
// Transforms that Map Integers to Integers. 1998 (5/3).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "format/band.h"

namespace gim {

enum class Direction { kAnalysis, kSynthesis };

// Reversible 5/3 on integers. Sums wrap, so that hostile values are harmless. Shifts round down.
struct Reversible53 {
    using Sample = int32_t;
    static constexpr int kSteps = 2;  // 0: high from low, 1: low from high

    template <Direction D>
    static Sample lift(int step, Sample x, Sample a, Sample b) {
        const uint32_t sum = static_cast<uint32_t>(a) + static_cast<uint32_t>(b);
        const int32_t change = step == 0 ? -(static_cast<int32_t>(sum) >> 1) : static_cast<int32_t>(sum + 2u) >> 2;
        const uint32_t u = static_cast<uint32_t>(change);
        return static_cast<int32_t>(static_cast<uint32_t>(x) + (D == Direction::kAnalysis ? u : 0u - u));
    }
};

// 9/7 on binary32: x + c * (a + b), or x - c * (a + b). Each operation rounds.
struct Irreversible97 {
    using Sample = float;
    static constexpr int kSteps = 4;  // even steps: high from low; odd steps: low from high
    static constexpr std::array<float, 4> kFactor = {-1.586134342f, -0.052980118f, 0.882911076f, 0.443506852f};
    // The gain of low samples within a level, over both directions. Between levels a constant image keeps its value.
    static constexpr float kLowGain = 1.513328328f;
    // The gain of one direction, for low samples at the ends of runs, and its inverse.
    static constexpr float kEndGain = 1.230174105f, kEndLoss = 0.8128931f;

    template <Direction D>
    static Sample lift(int step, Sample x, Sample a, Sample b) {
        const float change = kFactor[static_cast<size_t>(step)] * (a + b);
        return D == Direction::kAnalysis ? x + change : x - change;
    }
};

// target[i] = lift(target[i], a[i], b[i]).
template <class Wavelet, Direction D>
inline void lift_row(int step, typename Wavelet::Sample* __restrict target, const typename Wavelet::Sample* a,
                     const typename Wavelet::Sample* b, size_t count) {
    switch (step) {  // a constant step lets compilers vectorise the loop
        case 0:
            for (size_t i = 0; i < count; ++i) target[i] = Wavelet::template lift<D>(0, target[i], a[i], b[i]);
            break;
        case 1:
            for (size_t i = 0; i < count; ++i) target[i] = Wavelet::template lift<D>(1, target[i], a[i], b[i]);
            break;
        case 2:
            if constexpr (Wavelet::kSteps > 2)
                for (size_t i = 0; i < count; ++i) target[i] = Wavelet::template lift<D>(2, target[i], a[i], b[i]);
            break;
        default:
            if constexpr (Wavelet::kSteps > 2)
                for (size_t i = 0; i < count; ++i) target[i] = Wavelet::template lift<D>(3, target[i], a[i], b[i]);
    }
}

// The low samples that are lifted: all, unless a square shares its rim (format/rim.h). Then the 9/7 only scales those
// at the ends of a run: linear runs have no details up to their ends, and the rim is transformed by itself.
struct LiftedRange {
    size_t begin, end;
};
inline LiftedRange lifted_lows(size_t lows, bool keeps_ends) {
    return keeps_ends ? LiftedRange{1, lows - 1} : LiftedRange{0, lows};
}

// What an odd step does to a low sample that is kept: step 1 brings it to the gain of the others, or back.
template <class Wavelet, Direction D>
inline void lift_end(int step, typename Wavelet::Sample* low, size_t width) {
    if constexpr (Wavelet::kSteps > 2) {
        if (step != 1) return;
        constexpr float kFactor = D == Direction::kAnalysis ? Wavelet::kEndGain : Wavelet::kEndLoss;
        for (size_t i = 0; i < width; ++i) low[i] = low[i] * kFactor;
    }
}

// An odd step on a run of triples. `high` has room for a triple before and after. keeps: which low samples are kept;
// keeps.ends(), those at the ends; keeps(i), inner ones.
template <class Wavelet, Direction D, class Keeps>
inline void lift_lows(int step, size_t lows, size_t highs, typename Wavelet::Sample* low,
                      typename Wavelet::Sample* high, const Keeps& keeps) {
    for (size_t k = 0; k < 3; ++k) {
        *(high + k - 3) = high[k];
        high[3 * highs + k] = high[3 * (highs - 1) + k];
    }
    const auto lift = [&](size_t from, size_t to) {
        if (from < to)
            lift_row<Wavelet, D>(step, low + 3 * from, high + 3 * from - 3, high + 3 * from, 3 * (to - from));
    };
    const auto [begin, end] = lifted_lows(lows, keeps.ends());
    if (begin > 0) lift_end<Wavelet, D>(step, low, 3);
    size_t from = begin;
    for (size_t i = begin; i < end; ++i) {
        if (!keeps(i)) continue;
        lift(from, i);
        lift_end<Wavelet, D>(step, low + 3 * i, 3);
        from = i + 1;
    }
    lift(from, end);
    if (end < lows) lift_end<Wavelet, D>(step, low + 3 * end, 3);
}

// L2 norms of the 9/7 synthesis functions, 1 .. 14 levels below full resolution. low: of the low band. edge: of the two
// bands high in one direction. diagonal: of the band high in both.
struct BandNorms {
    float low, edge, diagonal;
};
inline constexpr std::array<BandNorms, 14> kBandNorms = {{
    {1.96590731f, 1.01128648f, 0.787260609f},
    {4.12240987f, 1.99681246f, 1.46371508f},
    {8.41674418f, 4.18336733f, 3.14659636f},
    {16.9355721f, 8.53411551f, 6.50804166f},
    {33.9249268f, 17.1667258f, 13.1458654f},
    {67.8771653f, 34.3852016f, 26.3604376f},
    {135.768047f, 68.7966629f, 52.755815f},
    {271.542961f, 137.606512f, 105.529185f},
    {543.089357f, 275.219624f, 211.067159f},
    {1086.18043f, 550.442549f, 422.138713f},
    {2172.36172f, 1100.88675f, 844.279625f},
    {4344.72387f, 2201.77432f, 1688.56035f},
    {8689.44795f, 4403.54906f, 3377.12125f},
    {17378.896f, 8807.09832f, 6754.24277f},
}};

// The step of a band's uniform quantizer: quantizer / norm. Depth 1: the finest bands. Low band of depth 0: the image.
inline float low_band_step(float quantizer, uint32_t depth) {
    return depth == 0 ? quantizer : quantizer / kBandNorms[depth - 1].low;
}
inline float band_step(float quantizer, uint32_t depth, Orientation orientation) {
    const BandNorms& norms = kBandNorms[depth - 1];
    return quantizer / (orientation == Orientation::kDiagonal ? norms.diagonal : norms.edge);
}

// The encoder's dead zone makes a bin reach further out than in. So a quantized coefficient stands for a value that is
// this part of a step beyond its magnitude.
inline constexpr float kReconstructionShift = 0.0625f;

inline float dequantize(int32_t q, float step) {
    const float shift = q > 0 ? kReconstructionShift : q < 0 ? -kReconstructionShift : 0.0f;
    return (static_cast<float>(q) + shift) * step;
}

}  // namespace gim

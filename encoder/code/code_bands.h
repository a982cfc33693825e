// Wavelet bands -> one stream per level of the file: quantization and entropy coding.  spec/gim-format.md,
// "Coefficients".
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/code/range_encoder.h"
#include "encoder/code/wavelet_analysis.h"
#include "format/detail_frame.h"
#include "format/rim.h"

namespace gim {

// Integer bands of one image: divided by their band's step and rounded with a dead zone. Details in frames are those of
// the image that a decoder has at that step.
struct QuantizedImage {
    Pyramid<int32_t> bands;
    std::vector<float> image;  // with details in frames: what a decoder makes of them, up to rounding; else empty
};
// seams: of a square whose mates share their details; they get the mean of both.
QuantizedImage quantize_bands(const Pyramid<float>& pyramid, const DetailCoding& coding,
                              const SeamTable* seams = nullptr);

// Positions' base is stored relative to the middle of their range.
template <class Sample>
void subtract_middle(Pyramid<Sample>* pyramid, uint32_t bits) {
    for (Sample& v : pyramid->base) v -= static_cast<Sample>(1 << (bits - 1));
}

// The base, if from_step is 0, and the bands of the steps after `from_step` that lead to a level (0: full resolution).
void code_steps(BandCoder<RangeEncoder>& coder, Pyramid<int32_t>& pyramid, uint32_t from_step, uint32_t to_level,
                const SeamTable* seams = nullptr);

// Streams of the image's levels, coarsest first. level_count: 1 .. exponent of the side; the first stream holds the
// base and all coarser bands.
std::vector<std::vector<uint8_t>> code_bands(Pyramid<int32_t>& pyramid, uint32_t level_count,
                                             CoefficientKind kind = CoefficientKind::kPlain,
                                             const SeamTable* seams = nullptr);

}  // namespace gim

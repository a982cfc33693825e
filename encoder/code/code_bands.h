// Quantizes wavelet bands and codes them to one stream per level of the file.  spec/gim-format.md, "Coefficients".
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/code/range_encoder.h"
#include "encoder/code/wavelet_analysis.h"
#include "format/detail_frame.h"
#include "format/rim.h"

namespace gim {

// Integer bands of one image: values are divided by the step of their band and rounded with a dead zone. Frames of
// details come from the image that a decoder has at that step.
struct QuantizedImage {
    Pyramid<int32_t> bands;
    std::vector<float> image;  // details in frames: the decoded image, up to rounding; else empty
};
// seams: of a square whose mates share their details; shared details become the mean of both.
QuantizedImage quantize_bands(const Pyramid<float>& pyramid, const DetailCoding& coding,
                              const SeamTable* seams = nullptr);

// The images that a decoder has on its way from such bands, the base first. details in frames only.
std::vector<std::vector<float>> decode_bands(const Pyramid<int32_t>& bands, const DetailCoding& coding,
                                             const SeamTable* seams = nullptr);

// The base of positions is stored relative to the middle of their range.
template <class Sample>
void subtract_middle(Pyramid<Sample>* pyramid, uint32_t bits) {
    for (Sample& v : pyramid->base) v -= static_cast<Sample>(1 << (bits - 1));
}

// Codes the bands of the steps from `from_step` up to a level (0: full resolution), and the base if from_step is 0.
void code_steps(BandCoder<RangeEncoder>& coder, Pyramid<int32_t>& pyramid, uint32_t from_step, uint32_t to_level,
                const SeamTable* seams = nullptr);

// Returns the streams of the image's levels, coarsest first. The first stream holds the base and all coarser bands.
// level_count: 1 .. exponent of the side.
std::vector<std::vector<uint8_t>> code_bands(Pyramid<int32_t>& pyramid, uint32_t level_count,
                                             CoefficientKind kind = CoefficientKind::kPlain,
                                             const SeamTable* seams = nullptr);

}  // namespace gim

// Chooses the quantizer that a rate target asks for, by coding and decoding until it is met.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "encoder/code/assemble_file.h"
#include "gim/encoder.h"

namespace gim {

// PSNR, in dB, of the surface that a file decodes to. Must be the same for the same bytes.
using JudgeFile = std::function<Result<double>(std::span<const uint8_t>)>;

// What an octave of the quantizer changes in files that are fitted to it (encoder/fit/fit_coded.h), about.
inline constexpr double kDecibelPerOctave = 4.3, kBytesPerOctave = 1.65;

// Is the quantizer searched for? Else the target says what it is.
bool is_searched(const RateTarget& target);

// How much coarser, in octaves, the quantizer of a file of that size and error might be for a target of bytes or PSNR.
double octaves_to(const RateTarget& target, double bytes, double psnr);

// A quantizer so many octaves coarser, at most `most` either way, in the range that searches cover.
double coarser_quantizer(double quantizer, double octaves, double most);

// A complete file that meets the target:
//   lossless  the quantized images are kept exactly
//   quality   no search: 75 is a step of 8 quantization steps of a 12-bit quantizer, 10 more halve it
//   psnr      the largest quantizer found whose file is judged not below `value`; an Error names the best in reach
//   bytes     the smallest quantizer found whose file is not above `value`; an Error names the smallest size in reach
// first: where searches begin, and what the others take. Cost: up to about 16 files written, each judged for psnr.
Result<std::vector<uint8_t>> code_to_target(const FileWriter& writer, double first, const RateTarget& target,
                                            const JudgeFile& judge);

// That of a quality, or of quality 75 for searches.
double first_quantizer(const RateTarget& target, uint32_t bits);

}  // namespace gim

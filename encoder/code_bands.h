// Wavelet bands -> one stream per level of the file: quantization and entropy coding.  spec/gim-format.md,
// "Coefficients".
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/wavelet_analysis.h"

namespace gim {

// Integer bands of one image; lossless ones as they are, lossy ones divided by their band's step and rounded with a
// dead zone. quantizer: units.
Pyramid<int32_t> quantize_bands(const Pyramid<float>& pyramid, float quantizer);

// Streams of the image's levels, coarsest first. level_count: 1 .. exponent of the side; the first stream holds the
// base and all coarser bands.
std::vector<std::vector<uint8_t>> code_bands(Pyramid<int32_t>& pyramid, uint32_t level_count);

}  // namespace gim

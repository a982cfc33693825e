// Checks the ranges of EncodeOptions.
#pragma once

#include <cstdint>

#include "encoder/base/result.h"
#include "gim/encoder.h"

namespace gim {

// What the encoder makes at most, asked or not.
inline constexpr uint32_t kMostSide = 8193, kMostSamples = 1u << 26;

// An Error names the option and its allowed values.
Result<void> check_options(const EncodeOptions& options);

}  // namespace gim

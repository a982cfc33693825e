// Checks the ranges of EncodeOptions.
#pragma once

#include "encoder/base/result.h"
#include "gim/encoder.h"

namespace gim {

// An Error names the option and its allowed values.
Result<void> check_options(const EncodeOptions& options);

}  // namespace gim

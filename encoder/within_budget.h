// What happens when a budget of bytes is too small.
#pragma once

#include <functional>

#include "encoder/base/result.h"
#include "gim/encoder.h"

namespace gim {

// Runs the encoder with the options. If no file that it finds keeps a budget of bytes, runs it again for the smallest
// file in reach, and returns that file if it keeps the budget. Else the Error names its size. The second run does not
// depend on the budget, so all budgets that are too small are told the same size.
Result<Encoded> within_budget(const EncodeOptions& options,
                              const std::function<Result<Encoded>(const EncodeOptions&)>& run);

}  // namespace gim

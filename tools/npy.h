// One NumPy array: .npy.
#pragma once

#include "tools/npz.h"

namespace gim {

Result<NumberArray> read_npy(std::span<const uint8_t> bytes, MemoryBudget& memory);
Bytes write_npy(const NumberArray& array);

}  // namespace gim

// NumPy arrays: .npz, a zip file of .npy files.
// https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gim/encoder.h"
#include "tools/file.h"
#include "tools/memory_budget.h"

namespace gim {

struct NumberArray {
    SampleType type = SampleType::kFloat32;
    bool is_bool = false;  // type: kUint8
    std::vector<uint64_t> shape;
    std::vector<double> values;  // the last axis runs fastest
};
using NamedArray = std::pair<std::string, NumberArray>;

bool is_npz(std::span<const uint8_t> bytes);

// Reads all arrays, in the order of the file. Fortran order and both byte orders are fine. Python objects, structures,
// complex numbers and text are refused.
Result<std::vector<NamedArray>> read_npz(std::span<const uint8_t> bytes, MemoryBudget& memory);

// Little-endian, C order, deflated. The same arrays give the same bytes.
Result<Bytes> write_npz(const std::vector<NamedArray>& arrays);

}  // namespace gim

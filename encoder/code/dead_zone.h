// How the encoder rounds coefficients.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gim {

// A band of triples, in units of their steps.
struct RealBand {
    std::span<const float> values;
    uint32_t rows, columns;

    float magnitude(uint32_t row, uint32_t column, uint32_t k) const {
        return std::abs(values[(size_t{row} * columns + column) * 3 + k]);
    }
};

// Rounds with a dead zone.
std::vector<int32_t> round_band(const RealBand& band, bool in_frames);

// Rounds values / step without a dead zone, because the base is not sparse.
std::vector<int32_t> quantize_base(const std::vector<float>& values, float step);

}  // namespace gim

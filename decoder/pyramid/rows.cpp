#include "decoder/pyramid/rows.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "format/lifting.h"

namespace gim {
namespace {

template <class Sample>
Sample* as(Number* numbers) {
    return reinterpret_cast<Sample*>(numbers);
}
template <class Sample>
const Sample* as(const Number* numbers) {
    return reinterpret_cast<const Sample*>(numbers);
}

LiftInteger integer_step(int number) { return LiftInteger({number, 0, true}); }
LiftFloat float_step(int number) {
    return LiftFloat({number, Irreversible97::kFactor[static_cast<size_t>(number)], true});
}

template <class Lift, class Sample>
GIM_ALWAYS_INLINE void lift_pair(const Lift& of_low, const Lift& of_high, Sample* __restrict low,
                                 Sample* __restrict high, const Sample* __restrict next_high,
                                 const Sample* __restrict previous_low, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        low[i] = of_low(low[i], high[i], next_high[i]);
        high[i] = of_high(high[i], previous_low[i], low[i]);
    }
}

// Values are hardly ever out of bounds, so it looks first.
GIM_ALWAYS_INLINE void bound_units(float* values, size_t count) {
    constexpr auto kLargest = std::bit_cast<int32_t>(kLargestUnit);
    int32_t beyond = 0;  // negative: some magnitude, read as an integer, is larger
    for (size_t i = 0; i < count; ++i) beyond |= kLargest - (std::bit_cast<int32_t>(values[i]) & INT32_MAX);
    if (beyond >= 0) return;
    for (size_t i = 0; i < count; ++i) {
        const float bounded = values[i] > -kLargestUnit ? values[i] : -kLargestUnit;
        values[i] = bounded < kLargestUnit ? bounded : kLargestUnit;
    }
}

}  // namespace

GIM_VECTOR_CLONES void RowLifting::undo(int step, Number* target, const Number* a, const Number* b,
                                        size_t count) const {
    if (integers_)
        lift_numbers(integer_step(step), as<int32_t>(target), as<int32_t>(a), as<int32_t>(b), count);
    else
        lift_numbers(float_step(step), as<float>(target), as<float>(a), as<float>(b), count);
}

GIM_VECTOR_CLONES void RowLifting::undo_pair(int step, Number* low, Number* high, const Number* next_high,
                                             const Number* previous_low, size_t count) const {
    if (integers_)
        lift_pair(integer_step(step), integer_step(step - 1), as<int32_t>(low), as<int32_t>(high),
                  as<int32_t>(next_high), as<int32_t>(previous_low), count);
    else
        lift_pair(float_step(step), float_step(step - 1), as<float>(low), as<float>(high), as<float>(next_high),
                  as<float>(previous_low), count);
}

void RowLifting::undo_end(int step, Number* low, size_t count) const {
    if (!integers_) lift_end<Irreversible97, Direction::kSynthesis>(step, as<float>(low), count);
}

GIM_VECTOR_CLONES void RowLifting::load_low(const Number* from, size_t count, Number* to) const {
    if (integers_) {
        std::copy_n(as<int32_t>(from), count, as<int32_t>(to));
    } else {
        const auto* floats = as<float>(from);
        auto* scaled = as<float>(to);
        for (size_t i = 0; i < count; ++i) scaled[i] = floats[i] * Irreversible97::kLowGain;
    }
}

GIM_VECTOR_CLONES void dequantize_row(const int32_t* values, size_t count, float step, float* floats) {
    for (size_t i = 0; i < count; ++i) floats[i] = dequantize(values[i], step);
}

GIM_VECTOR_CLONES void interleave(size_t lows, size_t highs, const Number* low, const Number* high, Number* row) {
    // Copies four numbers at a time: the next triple covers the fourth. The last pair may have no next triple.
    for (size_t i = 0; i + 1 < highs; ++i) {
        std::memcpy(row + 6 * i, low + 3 * i, 4 * sizeof(Number));
        std::memcpy(row + 6 * i + 3, high + 3 * i, 4 * sizeof(Number));
    }
    std::memcpy(row + 6 * (highs - 1), low + 3 * (highs - 1), 3 * sizeof(Number));
    std::memcpy(row + 6 * (highs - 1) + 3, high + 3 * (highs - 1), 3 * sizeof(Number));
    if (lows > highs) std::memcpy(row + 6 * highs, low + 3 * highs, 3 * sizeof(Number));
}

GIM_VECTOR_CLONES float* to_units(bool integers, void* numbers, size_t count) {
    if (integers) {
        auto* bytes = static_cast<std::byte*>(numbers);
        constexpr size_t kBlock = 256;
        int32_t from[kBlock];
        float to[kBlock];
        for (size_t i = 0; i < count; i += kBlock) {  // by memcpy: the two types share the memory
            const size_t n = std::min(kBlock, count - i);
            std::memcpy(from, bytes + i * 4, n * 4);
            for (size_t k = 0; k < n; ++k) to[k] = static_cast<float>(from[k]);
            std::memcpy(bytes + i * 4, to, n * 4);
        }
    }
    auto* values = static_cast<float*>(numbers);
    bound_units(values, count);
    return values;
}

GIM_VECTOR_CLONES void to_object(const std::array<float, 3>& origin, float step, const float* units,
                                 float* __restrict positions, size_t count) {
    constexpr size_t kGroup = 12;  // four triples at once, so that compilers vectorise the inner loop
    float origins[kGroup];
    for (size_t k = 0; k < kGroup; ++k) origins[k] = origin[k % 3];
    size_t i = 0;
    for (; i + kGroup <= 3 * count; i += kGroup)
        for (size_t k = 0; k < kGroup; ++k) positions[i + k] = origins[k] + step * units[i + k];
    for (size_t k = 0; i < 3 * count; ++i, ++k) positions[i] = origins[k] + step * units[i];
}

}  // namespace gim

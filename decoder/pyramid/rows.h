// Arithmetic on rows of numbers: the loops in which most of the time goes, apart from entropy decoding. A small build
// optimises this file for speed and the rest for size.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "format/inline.h"
#include "format/lift_number.h"

namespace gim {

// The inverse of a wavelet's lifting steps. The last step changed the low samples.
class RowLifting {
  public:
    explicit RowLifting(bool integers) : integers_(integers) {}  // 5/3 or 9/7

    bool integers() const { return integers_; }
    int pairs() const { return integers_ ? 1 : 2; }
    // The step that changed low samples, of pair i in the order of undoing.
    int low_step(int i) const { return 2 * (pairs() - i) - 1; }

    // target[i] from a[i] and b[i]. No two arrays overlap, but a and b may.
    GIM_NEVER_INLINE void undo(int step, Number* target, const Number* a, const Number* b, size_t count) const;
    // low[i] from high[i] and next_high[i] by an odd step, then high[i] from previous_low[i] and low[i] by the step before
    // it. The arrays do not overlap.
    GIM_NEVER_INLINE void undo_pair(int step, Number* low, Number* high, const Number* next_high,
                                    const Number* previous_low, size_t count) const;
    // The odd step on low samples that are kept (format/lifting.h, lift_end).
    GIM_NEVER_INLINE void undo_end(int step, Number* low, size_t count) const;
    // Low samples of a coarser image as those of this one.
    GIM_NEVER_INLINE void load_low(const Number* from, size_t count, Number* to) const;

  private:
    bool integers_;
};

// Returns whether any is not 0.
inline bool any_of(const int32_t* values, size_t count) {
    int32_t all = 0;
    for (size_t i = 0; i < count; ++i) all |= values[i];
    return all != 0;
}

// Floats from quantized ones.
GIM_NEVER_INLINE void dequantize_row(const int32_t* values, size_t count, float step, float* floats);

// Writes low and high triples in turn: as many low ones as high ones, or one more. There is room for a triple behind each.
GIM_NEVER_INLINE void interleave(size_t lows, size_t highs, const Number* low, const Number* high, Number* row);

// Turns the numbers of an image into floats within +-kLargestUnit, in place. A NaN becomes the least.
inline constexpr float kLargestUnit = 0x1p22f;  // encoders stay well below; keeps all later arithmetic finite
GIM_NEVER_INLINE float* to_units(bool integers, void* numbers, size_t count);

// Turns `count` triples from units into object space.
GIM_NEVER_INLINE void to_object(const std::array<float, 3>& origin, float step, const float* units, float* positions,
                                size_t count = 1);

}  // namespace gim

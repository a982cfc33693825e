// How wavelet coefficients become binary decisions: one traversal, used by encoder and decoder with their own coder.
// spec/gim-format.md, "Coefficients".
//
// A band is a grid of integer triples (x, y, z). Blocks of 8x8 triples that are all zero cost one decision. A magnitude
// is coded against what its decoded neighbours, its parent in the coarser band and the components before it let expect:
// low bits that are noise at this scale are raw, the rest is unary with adaptive models, long ones end in an
// Elias-gamma code. After: the context modelling of EBCOT / ECECOW reduced to one expected magnitude per component.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "format/bit_model.h"
#include "format/status.h"

namespace gim {

enum class Orientation : uint8_t { kHorizontal, kVertical, kDiagonal };  // the direction of high frequency

// rows * columns triples, row-major, without gaps.
struct Band {
    int32_t* values = nullptr;
    uint32_t rows = 0, columns = 0;

    size_t count() const { return size_t{rows} * columns * 3; }
    int32_t* row(uint32_t r) const { return values + size_t{r} * columns * 3; }
};

// The adaptive state of one image; it goes on from level to level. Coder below is a RangeEncoder or a RangeDecoder:
//   kWrites; uint32_t code_bit(BitModel&, uint32_t bit), code_raw(uint32_t value, uint32_t count), both return what was
//   coded, and a decoder ignores the value it is given.
class BandModels {
  public:
    static constexpr uint32_t kUnary = 14;   // decisions before the escape
    static constexpr uint32_t kScaled = 11;  // first class that has raw bits; it and the next serve all larger ones
    static constexpr uint32_t kClasses = kScaled + 2;  // of expected magnitude
    static constexpr uint32_t kMaxMagnitudeBits = 25;

    struct Magnitude {
        std::array<BitModel, kUnary> unary;
    };
    std::array<std::array<Magnitude, kClasses>, 3> magnitude;  // per component
    std::array<BitModel, 32> escape;
    std::array<BitModel, 12> block;
};

// Memory that code_band works in; contents undefined before and after.
struct BandWork {
    static constexpr uint32_t kGuard = 3;  // one triple either side

    uint32_t* above = nullptr;    // magnitudes of the row above, of this row and what is expected: each
    uint32_t* current = nullptr;  // row_size(columns) numbers
    uint32_t* expected = nullptr;
    uint8_t* full_above = nullptr;  // block_size(columns) flags: is the block not empty?

    static size_t row_size(uint32_t columns) { return (size_t{columns} + 2) * 3; }
    static size_t block_size(uint32_t columns) { return size_t{columns} / 8 + 2; }
};

inline uint32_t magnitude_of(int32_t v) { return static_cast<uint32_t>(v < 0 ? -v : v); }

// Class of an expected magnitude (in 1/16), and how many raw low bits go with it: half-octaves, and from four units on
// each octave shifts one more bit out, so that what is left has the same distribution.
struct MagnitudeClass {
    uint32_t index = 0, raw_bits = 0;
};
inline MagnitudeClass magnitude_class(uint32_t expected) {
    if (expected < 2) return {expected, 0};
    const uint32_t octave = static_cast<uint32_t>(std::bit_width(expected)) - 1;
    const uint32_t half_octave = 2 * octave + (expected >> (octave - 1) & 1) + 1 - 2;
    if (half_octave < BandModels::kScaled) return {half_octave, 0};
    const uint32_t above = half_octave - BandModels::kScaled;
    return {BandModels::kScaled + (above & 1), 1 + above / 2};
}

template <class Coder>
class BandCoder {
  public:
    BandCoder(Coder* coder, BandModels* models, const BandWork& work) : coder_(*coder), models_(*models), work_(work) {}

    // Writes the band's values, or fills them in. parent: the band of the same orientation one level coarser, or
    // nullptr. False when a value is too large to be of any writer's making.
    bool code(const Band& band, const Band* parent);

  private:
    void code_block_flags(const Band& band, uint32_t block_row);
    bool code_run(const Band& band, const Band* parent, uint32_t row, uint32_t begin, uint32_t end);
    bool code_value(uint32_t component, uint32_t expected, int32_t* value);

    Coder& coder_;
    BandModels& models_;
    BandWork work_;
};

// ---- implementation ----

template <class Coder>
bool BandCoder<Coder>::code_value(uint32_t component, uint32_t expected, int32_t* value) {
    const MagnitudeClass c = magnitude_class(expected);
    auto& unary = models_.magnitude[component][c.index].unary;
    const uint32_t known = magnitude_of(*value);
    const uint32_t known_high = known >> c.raw_bits;
    uint32_t high = 0;
    while (high < BandModels::kUnary && coder_.code_bit(unary[high], known_high > high)) ++high;
    if (high == BandModels::kUnary) {
        // Elias-gamma of what is left, plus one.
        const uint32_t known_left = known_high >= BandModels::kUnary ? known_high - BandModels::kUnary + 1 : 1;
        const uint32_t known_width = static_cast<uint32_t>(std::bit_width(known_left)) - 1;
        uint32_t width = 0;
        while (coder_.code_bit(models_.escape[width], known_width > width)) {
            if (++width + c.raw_bits > BandModels::kMaxMagnitudeBits) return false;
        }
        const uint32_t low = coder_.code_raw(known_left & ((1u << width) - 1), width);
        high += (1u << width | low) - 1;
    }
    uint32_t magnitude = high;
    if (c.raw_bits > 0) {
        if (c.raw_bits > BandModels::kMaxMagnitudeBits - 1) return false;
        magnitude = high << c.raw_bits | coder_.code_raw(known & ((1u << c.raw_bits) - 1), c.raw_bits);
    }
    if (magnitude >> BandModels::kMaxMagnitudeBits != 0) return false;
    const uint32_t sign = magnitude == 0 ? 0 : coder_.code_raw(*value < 0, 1);
    *value = sign ? -static_cast<int32_t>(magnitude) : static_cast<int32_t>(magnitude);
    return true;
}

template <class Coder>
void BandCoder<Coder>::code_block_flags(const Band& band, uint32_t block_row) {
    const uint32_t blocks = (band.columns + 7) / 8;
    const uint32_t row_begin = block_row * 8, row_end = std::min(band.rows, row_begin + 8);
    uint32_t left = 1;
    for (uint32_t b = 0; b < blocks; ++b) {
        uint32_t known = 0;
        if constexpr (Coder::kWrites) {
            const uint32_t begin = b * 8 * 3, end = std::min(band.columns, b * 8 + 8) * 3;
            for (uint32_t r = row_begin; r < row_end && !known; ++r)
                known = std::any_of(band.row(r) + begin, band.row(r) + end, [](int32_t v) { return v != 0; });
        }
        const uint32_t context = left + 2u * work_.full_above[b];
        left = coder_.code_bit(models_.block[context], known);
        work_.full_above[b] = static_cast<uint8_t>(left);
    }
}

// Columns begin .. end-1 of a row, all in blocks that are not empty.
template <class Coder>
bool BandCoder<Coder>::code_run(const Band& band, const Band* parent, uint32_t row, uint32_t begin, uint32_t end) {
    const uint32_t guard = BandWork::kGuard;
    const uint32_t* above = work_.above + guard;
    uint32_t* current = work_.current + guard;
    uint32_t* expected = work_.expected + guard;
    const int32_t first = static_cast<int32_t>(begin * 3), last = static_cast<int32_t>(end * 3);
    for (int32_t i = first; i < last; ++i) expected[i] = 5 * above[i] + 2 * (above[i - 3] + above[i + 3]);
    if (parent) {
        const int32_t* from = parent->row(row / 2);
        for (uint32_t column = begin; column < end; ++column)
            for (uint32_t k = 0; k < 3; ++k) expected[column * 3 + k] += 2 * magnitude_of(from[column / 2 * 3 + k]);
    }
    int32_t* values = band.row(row);
    for (int32_t i = first; i < last; i += 3) {
        // Half the sum of the components before, in place of as much of the neighbours' say.
        if (!code_value(0, expected[i] + 5 * current[i - 3], values + i)) return false;
        current[i] = magnitude_of(values[i]);
        if (!code_value(1, (expected[i + 1] + 5 * current[i - 2]) * 3 / 4 + 4 * current[i], values + i + 1))
            return false;
        current[i + 1] = magnitude_of(values[i + 1]);
        if (!code_value(2, (expected[i + 2] + 5 * current[i - 1]) * 3 / 4 + 2 * (current[i] + current[i + 1]),
                        values + i + 2))
            return false;
        current[i + 2] = magnitude_of(values[i + 2]);
    }
    return true;
}

template <class Coder>
bool BandCoder<Coder>::code(const Band& band, const Band* parent) {
    const size_t row_size = BandWork::row_size(band.columns);
    const uint32_t blocks = (band.columns + 7) / 8;
    std::fill_n(work_.above, row_size, 0u);
    std::fill_n(work_.full_above, blocks, uint8_t{1});
    for (uint32_t row = 0; row < band.rows; ++row) {
        if (row % 8 == 0) code_block_flags(band, row / 8);
        std::fill_n(work_.current, row_size, 0u);
        if constexpr (!Coder::kWrites) std::fill_n(band.row(row), size_t{band.columns} * 3, 0);
        for (uint32_t b = 0; b < blocks; ++b) {
            if (!work_.full_above[b]) continue;
            if (!code_run(band, parent, row, b * 8, std::min(band.columns, b * 8 + 8))) return false;
        }
        std::swap(work_.above, work_.current);
    }
    return true;
}

}  // namespace gim

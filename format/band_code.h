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

#include "format/bit_model.h"

namespace gim {

enum class Orientation : uint8_t { kHorizontal, kVertical, kDiagonal };  // the direction of high frequency

// rows * columns triples, row-major, without gaps.
struct Band {
    int32_t* values = nullptr;
    uint32_t rows = 0, columns = 0;

    size_t count() const { return size_t{rows} * columns * 3; }
    int32_t* row(uint32_t r) const { return values + size_t{r} * columns * 3; }
};

// A run of n samples splits into so many low and high ones (format/lifting.h).
constexpr uint32_t low_count(uint32_t n) { return n - n / 2; }
constexpr uint32_t high_count(uint32_t n) { return n / 2; }

// What is left of n samples after so many steps.
constexpr uint32_t halved(uint32_t n, uint32_t steps) {
    for (; steps > 0; --steps) n = low_count(n);
    return n;
}

// The three bands that lead to an image.
struct LevelBands {
    Band horizontal;  // low_count(rows) x high_count(columns)
    Band vertical;    // high_count(rows) x low_count(columns)
    Band diagonal;    // high_count(rows) x high_count(columns)

    const Band& of(Orientation orientation) const {
        return orientation == Orientation::kHorizontal ? horizontal
               : orientation == Orientation::kVertical ? vertical
                                                       : diagonal;
    }
};

// The adaptive state of one image; it goes on from level to level.
struct BandModels {
    static constexpr uint32_t kUnary = 14;   // decisions before the escape
    static constexpr uint32_t kScaled = 11;  // first class that has raw bits; it and the next serve all larger ones
    static constexpr uint32_t kClasses = kScaled + 2;  // of expected magnitude
    static constexpr uint32_t kMaxMagnitudeBits = 25;

    std::array<std::array<BitModel, kUnary>, kClasses> magnitude;
    std::array<BitModel, 32> escape;
    std::array<std::array<BitModel, 27>, 3> sign;  // per orientation, by the signs of above, left and parent
    std::array<BitModel, 4> block;
};

// Memory that BandCoder works in; contents undefined before and after. Rows have a zero triple on either side.
struct BandWork {
    static constexpr uint32_t kGuard = 3;

    int32_t* above = nullptr;       // the row above
    int32_t* current = nullptr;     // this row
    uint32_t* expected = nullptr;   // what the neighbours but the left one let expect
    uint8_t* full_above = nullptr;  // block_size(columns) flags: is the block not empty?

    static size_t row_size(uint32_t columns) { return (size_t{columns} + 2) * 3; }
    static size_t block_size(uint32_t columns) { return size_t{columns} / 8 + 1; }
};

inline uint32_t magnitude_of(int32_t v) { return static_cast<uint32_t>(v < 0 ? -v : v); }
inline uint32_t sign_class(int32_t v) { return v > 0 ? 1u : v < 0 ? 2u : 0u; }

// Class of an expected magnitude (in 1/16), and how many raw low bits go with it: half-octaves, and from four units on
// each octave shifts one more bit out, so that what is left has the same distribution.
struct MagnitudeClass {
    uint32_t index = 0, raw_bits = 0;
};
inline MagnitudeClass magnitude_class(uint32_t expected) {
    if (expected < 2) return {expected, 0};
    const uint32_t octave = static_cast<uint32_t>(std::bit_width(expected)) - 1;
    const uint32_t half_octave = 2 * octave - 1 + (expected >> (octave - 1) & 1);
    if (half_octave < BandModels::kScaled) return {half_octave, 0};
    const uint32_t above = half_octave - BandModels::kScaled;
    return {BandModels::kScaled + (above & 1), 1 + above / 2};
}

// Writes or fills in bands. Coder is a RangeEncoder or a RangeDecoder:
//   kWrites; uint32_t code_bit(BitModel&, uint32_t bit), code_raw(uint32_t value, uint32_t count); both return what was
//   coded, and a decoder ignores the value that it is given.
// All functions return false when a value is too large to be of any writer's making.
template <class Coder>
class BandCoder {
  public:
    BandCoder(Coder* coder, BandModels* models, const BandWork& work) : coder_(*coder), models_(*models), work_(work) {}

    // The coarsest image, 2 x 2 of a square.
    bool code_base(const Band& base) { return code_band(base, {}); }

    // parents: the bands of the next coarser level, or nullptr.
    bool code_level(const LevelBands& bands, const LevelBands* parents) {
        return code_band(bands.horizontal, {Orientation::kHorizontal, parents ? &parents->horizontal : nullptr}) &&
               code_band(bands.vertical,
                         {Orientation::kVertical, parents ? &parents->vertical : nullptr, &bands.horizontal}) &&
               code_band(bands.diagonal, {Orientation::kDiagonal, parents ? &parents->diagonal : nullptr,
                                          &bands.horizontal, &bands.vertical});
    }

  private:
    // What is known besides the band itself: the band above in the pyramid and those of the same level coded before.
    struct Surroundings {
        Orientation orientation = Orientation::kHorizontal;
        const Band* parent = nullptr;
        const Band* first_sibling = nullptr;
        const Band* second_sibling = nullptr;
    };

    bool code_band(const Band& band, const Surroundings& around);
    void code_block_flags(const Band& band, uint32_t row);
    void expect(const Surroundings& around, uint32_t row, uint32_t begin, uint32_t end);
    bool code_run(const Band& band, const Surroundings& around, uint32_t row, uint32_t begin, uint32_t end);
    bool code_value(uint32_t expected, BitModel& sign, int32_t* value);

    Coder& coder_;
    BandModels& models_;
    BandWork work_;
};

// ---- implementation ----

template <class Coder>
inline bool BandCoder<Coder>::code_value(uint32_t expected, BitModel& sign, int32_t* value) {
    const MagnitudeClass c = magnitude_class(expected);
    auto& unary = models_.magnitude[c.index];
    const uint32_t known = magnitude_of(*value);
    const uint32_t known_high = known >> c.raw_bits;
    uint32_t magnitude = 0;
    while (magnitude < BandModels::kUnary && coder_.code_bit(unary[magnitude], known_high > magnitude)) ++magnitude;
    if (magnitude == BandModels::kUnary) {
        // Elias-gamma of what is left, plus one.
        const uint32_t known_left = known_high >= BandModels::kUnary ? known_high - BandModels::kUnary + 1 : 1;
        const uint32_t known_width = static_cast<uint32_t>(std::bit_width(known_left)) - 1;
        uint32_t width = 0;
        while (coder_.code_bit(models_.escape[width], known_width > width)) {
            if (++width + c.raw_bits > BandModels::kMaxMagnitudeBits) return false;
        }
        magnitude += (1u << width | coder_.code_raw(known_left & ((1u << width) - 1), width)) - 1;
    }
    if (c.raw_bits > 0) {
        if (std::bit_width(magnitude) + c.raw_bits > BandModels::kMaxMagnitudeBits) return false;
        magnitude = magnitude << c.raw_bits | coder_.code_raw(known & ((1u << c.raw_bits) - 1), c.raw_bits);
    }
    if (magnitude >> BandModels::kMaxMagnitudeBits != 0) return false;
    const bool negative = magnitude != 0 && coder_.code_bit(sign, *value < 0);
    *value = negative ? -static_cast<int32_t>(magnitude) : static_cast<int32_t>(magnitude);
    return true;
}

// One flag per block of the block row that begins at `row`.
template <class Coder>
void BandCoder<Coder>::code_block_flags(const Band& band, uint32_t row) {
    const uint32_t blocks = (band.columns + 7) / 8;
    uint32_t left = 1;
    for (uint32_t b = 0; b < blocks; ++b) {
        uint32_t known = 0;
        if constexpr (Coder::kWrites) {
            const uint32_t begin = b * 8 * 3, end = std::min(band.columns, b * 8 + 8) * 3;
            for (uint32_t r = row; r < std::min(band.rows, row + 8) && !known; ++r)
                known = std::any_of(band.row(r) + begin, band.row(r) + end, [](int32_t v) { return v != 0; });
        }
        left = coder_.code_bit(models_.block[left + 2u * work_.full_above[b]], known);
        work_.full_above[b] = static_cast<uint8_t>(left);
    }
}

// Weighs the neighbours of columns begin .. end-1: in 1/16 of the magnitude that they let expect.
template <class Coder>
void BandCoder<Coder>::expect(const Surroundings& around, uint32_t row, uint32_t begin, uint32_t end) {
    const int32_t* above = work_.above + BandWork::kGuard;
    uint32_t* expected = work_.expected + BandWork::kGuard;
    const int32_t first = static_cast<int32_t>(begin * 3), last = static_cast<int32_t>(end * 3);
    for (int32_t i = first; i < last; ++i)
        expected[i] = 5 * magnitude_of(above[i]) + 2 * (magnitude_of(above[i - 3]) + magnitude_of(above[i + 3]));
    if (around.parent && row / 2 < around.parent->rows) {
        const int32_t* from = around.parent->row(row / 2);
        const uint32_t parent_end = std::min(end, 2 * around.parent->columns);
        for (uint32_t column = begin; column < parent_end; ++column)
            for (uint32_t k = 0; k < 3; ++k) expected[column * 3 + k] += magnitude_of(from[column / 2 * 3 + k]);
    }
    // A sibling has up to one row or column less, or more.
    const auto add_sibling = [&](const Band* sibling, uint32_t weight) {
        if (!sibling || row >= sibling->rows) return;
        const int32_t* from = sibling->row(row);
        const int32_t sibling_last = static_cast<int32_t>(std::min(end, sibling->columns) * 3);
        for (int32_t i = first; i < sibling_last; ++i) expected[i] += weight * magnitude_of(from[i]);
    };
    add_sibling(around.first_sibling, around.second_sibling ? 1 : 2);
    add_sibling(around.second_sibling, 1);
}

// Columns begin .. end-1 of a row, all in blocks that are not empty.
template <class Coder>
bool BandCoder<Coder>::code_run(const Band& band, const Surroundings& around, uint32_t row, uint32_t begin,
                                uint32_t end) {
    expect(around, row, begin, end);
    const int32_t* above = work_.above + BandWork::kGuard;
    int32_t* current = work_.current + BandWork::kGuard;
    const uint32_t* expected = work_.expected + BandWork::kGuard;
    int32_t* values = band.row(row);
    auto& signs = models_.sign[static_cast<size_t>(around.orientation)];
    constexpr int32_t kNoParent[3] = {0, 0, 0};
    const bool has_parent = around.parent && row / 2 < around.parent->rows;
    for (uint32_t column = begin; column < end; ++column) {
        const int32_t* parent = has_parent && column / 2 < around.parent->columns
                                    ? around.parent->row(row / 2) + column / 2 * 3
                                    : kNoParent;
        uint32_t before = 0;  // magnitudes of the components before
        for (int32_t k = 0; k < 3; ++k) {
            const int32_t i = static_cast<int32_t>(column * 3) + k;
            uint32_t e = expected[i] + 5 * magnitude_of(current[i - 3]);
            if (k > 0) e = e * 3 / 4 + 4 * before;
            const uint32_t sign = (sign_class(above[i]) * 3 + sign_class(current[i - 3])) * 3 + sign_class(parent[k]);
            int32_t value = values[i];
            if (!code_value(e, signs[sign], &value)) return false;
            values[i] = current[i] = value;
            before += magnitude_of(value);
        }
    }
    return true;
}

template <class Coder>
bool BandCoder<Coder>::code_band(const Band& band, const Surroundings& around) {
    const size_t row_size = BandWork::row_size(band.columns);
    const uint32_t blocks = (band.columns + 7) / 8;
    std::fill_n(work_.above, row_size, 0);
    std::fill_n(work_.full_above, blocks, uint8_t{1});
    for (uint32_t row = 0; row < band.rows; ++row) {
        if (row % 8 == 0) code_block_flags(band, row);
        std::fill_n(work_.current, row_size, 0);
        if constexpr (!Coder::kWrites) std::fill_n(band.row(row), size_t{band.columns} * 3, 0);
        for (uint32_t b = 0; b < blocks; ++b) {
            if (!work_.full_above[b]) continue;
            if (!code_run(band, around, row, b * 8, std::min(band.columns, b * 8 + 8))) return false;
        }
        std::swap(work_.above, work_.current);
    }
    return true;
}

}  // namespace gim

// Turns wavelet coefficients into binary decisions. Encoder and decoder share this traversal, each with its own coder.
// spec/gim-format.md, "Bands" and "Values".
//
// A band is a grid of integer triples: x, y, z, or in local frames a normal component and two tangential ones. A block
// of 8x8 zero triples costs one decision. A magnitude is coded against the one expected from its decoded neighbours,
// its parent in the coarser band, the other bands and the components before it. Low bits that are noise at this scale
// are raw. The rest is unary with adaptive models; long ones end in an Elias-gamma code. After: the contexts of EBCOT /
// ECECOW, reduced to one expected magnitude per component; weights are fitted, models start trained.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "format/band.h"
#include "format/bit_model.h"
#include "format/expectation.h"
#include "format/inline.h"
#include "format/rim.h"
#include "format/trained_models.h"

namespace gim {

// The adaptive state of one image. It carries over from level to level.
struct BandModels {
    static constexpr uint32_t kUnary = 14;   // decisions before the escape
    static constexpr uint32_t kScaled = 15;  // first class with raw bits; it and the next serve all larger ones
    static constexpr uint32_t kClasses = kScaled + 2;  // of expected magnitude
    static constexpr uint32_t kMaxMagnitudeBits = 25;

    explicit BandModels(CoefficientKind coefficients);
    // Calls f(model) for every model, in the order of the tables in the spec.
    template <class F>
    void for_each(F&& f);

    CoefficientKind kind;
    std::array<BitModel, 12> block;  // by the blocks left and above, and by the parent band there
    // Sets: of the first component; of a later one; of the last one if the second is not 0.
    // Each has kUnary models in an array of 16, which is quicker to index.
    std::array<std::array<std::array<BitModel, 16>, kClasses>, 3> magnitude;
    std::array<std::array<BitModel, 2>, kClasses> pair;  // in frames: whether any tangential component is not 0
    std::array<BitModel, 32> escape;
    // By component (first or later), by orientation, by the signs of above, left and parent.
    std::array<std::array<std::array<BitModel, 27>, 3>, 2> sign;
};

inline uint32_t sign_class(int32_t v) { return v > 0 ? 1u : v < 0 ? 2u : 0u; }

// The class of an expected magnitude (in 1/256) and its number of raw low bits. Classes are half-octaves. From four
// units on, each octave makes one more bit raw, so that the rest keeps the same distribution.
struct MagnitudeClass {
    uint32_t index = 0, raw_bits = 0;
};
constexpr MagnitudeClass compute_magnitude_class(uint32_t expected) {
    expected /= 4;
    if (expected < 2) return {expected, 0};
    const uint32_t octave = static_cast<uint32_t>(std::bit_width(expected)) - 1;
    const uint32_t half_octave = 2 * octave - 1 + (expected >> (octave - 1) & 1);
    if (half_octave < BandModels::kScaled) return {half_octave, 0};
    const uint32_t above = half_octave - BandModels::kScaled;
    return {BandModels::kScaled + (above & 1), 1 + above / 2};
}
// Table of the classes without raw bits: most magnitudes are that small.
inline constexpr auto kSmallClasses = [] {
    std::array<uint8_t, 256> classes{};
    for (uint32_t i = 0; i < classes.size(); ++i)
        classes[i] = static_cast<uint8_t>(compute_magnitude_class(i * 4).index);
    return classes;
}();
static_assert(compute_magnitude_class(kSmallClasses.size() * 4 - 1).raw_bits == 0);
static_assert(compute_magnitude_class(kSmallClasses.size() * 4).raw_bits == 1);
GIM_ALWAYS_INLINE MagnitudeClass magnitude_class(uint32_t expected) {
    if (expected / 4 < kSmallClasses.size()) return {kSmallClasses[expected / 4], 0};
    return compute_magnitude_class(expected);
}

// Writes bands or fills them in. Coder is a RangeEncoder or a RangeDecoder. It has:
//  kWrites; uint32_t code_bit(BitModel&, uint32_t bit), code_raw(uint32_t value, uint32_t count). Both return what was
//  coded; a decoder ignores the value that it is given.
// All functions return false if a value is larger than any that an encoder writes.
template <class Coder>
class BandCoder {
  public:
    BandCoder(Coder* coder, BandModels* models, const BandWork& work) : coder_(*coder), models_(*models), work_(work) {}

    // Codes the coarsest image: 2 x 2 samples of a square.
    bool code_base(const Band& base) {
        return code_band(base, {Orientation::kHorizontal, nullptr, nullptr, nullptr, kBaseWeights, {}});
    }

    // parents: the bands of the next coarser level, or nullptr. Copies on the rim are zero and are not coded.
    bool code_level(const LevelBands& bands, const LevelBands* parents, const SharedRim& rim = {}) {
        const uint32_t columns = bands.horizontal.columns + bands.vertical.columns;
        const uint32_t rows = bands.horizontal.rows + bands.vertical.rows;
        const auto& weights = kBandWeights[static_cast<size_t>(models_.kind)][std::min(columns, rows) >= kFineSide];
        return code_band(bands.horizontal, {Orientation::kHorizontal, parents ? &parents->horizontal : nullptr, nullptr,
                                            nullptr, weights[0], rim}) &&
               code_band(bands.vertical, {Orientation::kVertical, parents ? &parents->vertical : nullptr,
                                          &bands.horizontal, nullptr, weights[1], rim}) &&
               code_band(bands.diagonal, {Orientation::kDiagonal,
                                          parents ? &parents->diagonal : nullptr,
                                          &bands.horizontal,
                                          &bands.vertical,
                                          weights[2],
                                          {}});
    }

  protected:
    // Codes columns begin .. end-1 of a row, all in blocks that are not empty. before: the magnitudes of the triple at
    // the left, or nullptr for zeros.
    bool code_run(const Band& band, const BandSurroundings& around, uint32_t row, uint32_t begin, uint32_t end,
                  const uint32_t* before = nullptr);

    Coder& coder_;
    BandModels& models_;
    BandWork work_;

  private:
    bool code_band(const Band& band, const BandSurroundings& around);
    void code_block_flags(const Band& band, const BandSurroundings& around, uint32_t row);
    void clear_empty_blocks(uint32_t columns);
};

// ---- implementation ----

template <class F>
void BandModels::for_each(F&& f) {
    for (BitModel& m : block) f(m);
    for (auto& set : magnitude)
        for (auto& c : set)
            for (uint32_t i = 0; i < kUnary; ++i) f(c[i]);
    for (auto& c : pair)
        for (BitModel& m : c) f(m);
    for (BitModel& m : escape) f(m);
    for (auto& component : sign)
        for (auto& orientation : component)
            for (BitModel& m : orientation) f(m);
}

inline BandModels::BandModels(CoefficientKind coefficients) : kind(coefficients) {
    const char* code = kTrainedModels[static_cast<size_t>(kind)];
    for_each([&](BitModel& model) {
        model = trained_model(code);
        code += 2;
    });
}

// *value holds the magnitude to write and receives the coded one. not_zero: it is known not to be 0.
template <class Coder>
GIM_ALWAYS_INLINE bool code_magnitude(Coder& coder, BandModels& models, uint32_t set, uint32_t expected, bool not_zero,
                                      uint32_t* value) {
    const MagnitudeClass c = magnitude_class(expected);
    auto& unary = models.magnitude[set][c.index];
    const uint32_t known = *value;
    const uint32_t known_high = known >> c.raw_bits;
    uint32_t magnitude = not_zero && c.raw_bits == 0 ? 1 : 0;
    while (magnitude < BandModels::kUnary && coder.code_bit(unary[magnitude], known_high > magnitude)) ++magnitude;
    if (magnitude == BandModels::kUnary) {
        // The Elias-gamma code of the rest plus one.
        const uint32_t known_left = known_high >= BandModels::kUnary ? known_high - BandModels::kUnary + 1 : 1;
        const uint32_t known_width = static_cast<uint32_t>(std::bit_width(known_left)) - 1;
        uint32_t width = 0;
        while (coder.code_bit(models.escape[width], known_width > width)) {
            if (++width + c.raw_bits > BandModels::kMaxMagnitudeBits) return false;
        }
        magnitude += (1u << width | coder.code_raw(known_left & ((1u << width) - 1), width)) - 1;
    }
    if (c.raw_bits > 0) {
        if (std::bit_width(magnitude) + c.raw_bits > BandModels::kMaxMagnitudeBits) return false;
        magnitude = magnitude << c.raw_bits | coder.code_raw(known & ((1u << c.raw_bits) - 1), c.raw_bits);
    }
    *value = magnitude;
    return magnitude >> BandModels::kMaxMagnitudeBits == 0;
}

// Codes one flag per block of the block row that begins at `row`.
template <class Coder>
void BandCoder<Coder>::code_block_flags(const Band& band, const BandSurroundings& around, uint32_t row) {
    const uint32_t blocks = block_count(band.columns);
    uint32_t left = 1;
    for (uint32_t b = 0; b < blocks; ++b) {
        uint32_t parents = 0;  // triples that are not zero; more than three count as three
        if (around.parent) {
            const uint32_t end = std::min(around.parent->columns, b * 4 + 4);
            const uint32_t rows_end = std::min(around.parent->rows, row / 2 + 4);
            for (uint32_t r = row / 2; r < rows_end && parents <= 2; ++r) {
                const int32_t* from = around.parent->row(r);
                for (uint32_t c = b * 4; c < end; ++c)
                    parents += (from[c * 3] | from[c * 3 + 1] | from[c * 3 + 2]) != 0;
            }
        }
        uint32_t known = 0;
        if constexpr (Coder::kWrites) {
            const uint32_t begin = b * 8 * 3, end = std::min(band.columns, b * 8 + 8) * 3;
            for (uint32_t r = row; r < std::min(band.rows, row + 8) && !known; ++r)
                known = std::any_of(band.row(r) + begin, band.row(r) + end, [](int32_t v) { return v != 0; });
        }
        const uint32_t above = work_.full_above[b];
        left = coder_.code_bit(models_.block[left + 2 * above + 4 * ((parents > 0) + (parents > 2))], known);
        work_.full_above[b] = left;
    }
}

template <class Coder>
bool BandCoder<Coder>::code_run(const Band& band, const BandSurroundings& around, uint32_t row, uint32_t begin,
                                uint32_t end, const uint32_t* before) {
    expect(around, row, begin, end, work_);
    // A decoder is copied so that its state can stay in registers. After a failure nobody uses it again.
    std::conditional_t<Coder::kWrites, Coder&, Coder> coder = coder_;
    BandModels& models = models_;
    const BandWeights first = around.weights[0], later = around.weights[1];  // copies, which no write changes
    const bool paired = is_in_frames(models.kind);
    const bool across = around.orientation == Orientation::kVertical;
    const bool has_copies = around.rim && (across || row == 0 || row + 1 == band.rows);
    int32_t* values = band.row(row);
    const int32_t* values_above = row > 0 ? values - size_t{band.columns} * 3 : nullptr;
    const bool has_parent = around.parent && row / 2 < around.parent->rows;
    const int32_t* parents = has_parent ? around.parent->row(row / 2) : nullptr;
    const uint32_t parents_end = has_parent ? 2 * around.parent->columns : 0;  // columns before this one have a parent
    // Codes the sign of component k, whose magnitude is not 0.
    const auto code_sign = [&](uint32_t k, uint32_t column) GIM_ALWAYS_INLINE_LAMBDA {
        const uint32_t i = column * 3 + k;
        const uint32_t above = values_above ? sign_class(values_above[i]) : 0;
        const uint32_t left = column > 0 ? sign_class(values[i - 3]) : 0;
        const uint32_t of_parent = column < parents_end ? sign_class(parents[column / 2 * 3 + k]) : 0;
        auto& signs = models.sign[std::min(k, 1u)][static_cast<size_t>(around.orientation)];
        return coder.code_bit(signs[(above * 3 + left) * 3 + of_parent], values[i] < 0) != 0;
    };
    uint32_t left[3] = {0, 0, 0};  // magnitudes of the triple before; most runs begin after an empty one
    if (before) std::copy_n(before, 3, left);
    for (uint32_t column = begin; column < end; ++column) {
        const size_t at = size_t{column} * 3;
        uint32_t* magnitudes = work_.magnitudes + at;  // still those of the row above
        const uint32_t above1 = magnitudes[1], above2 = magnitudes[2];
        std::fill_n(magnitudes, 3, 0u);
        if (has_copies && (!across || column == 0 || column + 1 == band.columns) &&
            around.rim.is_copy(around.orientation, row, column)) {
            std::fill_n(left, 3, 0u);
            continue;
        }
        uint32_t magnitude[3] = {0, 0, 0};
        const auto code = [&](uint32_t k, uint32_t set, uint32_t e, bool not_zero) GIM_ALWAYS_INLINE_LAMBDA {
            uint32_t& m = magnitude[k];
            m = magnitude_of(values[at + k]);
            if (!code_magnitude(coder, models, set, e, not_zero, &m)) return false;
            if (m == 0) return true;
            magnitudes[k] = m;
            values[at + k] = code_sign(k, column) ? -static_cast<int32_t>(m) : static_cast<int32_t>(m);
            return true;
        };
        const uint32_t* expected = work_.expected + at;
        const uint32_t beside1 = left[1] + above1, beside2 = left[2] + above2;
        const uint32_t e0 = expected[0] + first.left * left[0] + first.cross * (beside1 + beside2);
        if (!code(0, 0, e0, false)) return false;
        const uint32_t by_first = later.first * magnitude[0];
        const uint32_t e1 = expected[1] + later.left * left[1] + later.cross * beside2 + by_first;
        const uint32_t e2 = expected[2] + later.left * left[2] + later.cross * beside1 + by_first;
        std::copy_n(magnitude, 3, left);
        if (paired) {
            const uint32_t any = (values[at + 1] | values[at + 2]) != 0;
            if (!coder.code_bit(models.pair[magnitude_class(e1 + e2).index][magnitude[0] != 0], any)) continue;
        }
        if (!code(1, 1, e1, false)) return false;
        const uint32_t set = magnitude[1] != 0 ? 2 : 1;
        if (!code(2, set, e2 + later.second * magnitude[1], paired && magnitude[1] == 0)) return false;
        std::copy_n(magnitude, 3, left);
    }
    if constexpr (!Coder::kWrites) coder_ = coder;
    return true;
}

// Clears the magnitudes in empty blocks. They are still those of the row above, which belongs to other blocks.
template <class Coder>
void BandCoder<Coder>::clear_empty_blocks(uint32_t columns) {
    for (uint32_t begin = 0; begin < columns; begin += 8) {
        if (!work_.full_above[begin / 8])
            std::fill_n(work_.magnitudes + size_t{begin} * 3, std::min(columns - begin, 8u) * 3, 0u);
    }
}

template <class Coder>
bool BandCoder<Coder>::code_band(const Band& band, const BandSurroundings& around) {
    const uint32_t blocks = block_count(band.columns);
    std::fill_n(work_.magnitudes - 3, (size_t{band.columns} + 2) * 3, 0u);  // includes the margin at either end
    std::fill_n(work_.full_above, blocks, 1u);
    for (uint32_t row = 0; row < band.rows; ++row) {
        if (row % 8 == 0) code_block_flags(band, around, row);
        if constexpr (!Coder::kWrites) std::fill_n(band.row(row), size_t{band.columns} * 3, 0);
        for (uint32_t b = 0; b < blocks;) {
            const uint32_t first = b++;
            if (!work_.full_above[first]) continue;
            while (b < blocks && work_.full_above[b]) ++b;
            if (!code_run(band, around, row, first * 8, std::min(band.columns, b * 8))) return false;
        }
        if (row % 8 == 0) clear_empty_blocks(band.columns);
    }
    return true;
}

}  // namespace gim

// How wavelet coefficients become binary decisions: one traversal, used by encoder and decoder with their own coder.
// spec/gim-format.md, "Bands" and "Values".
//
// A band is a grid of integer triples: x, y, z, or in local frames the normal component and two tangential ones. Blocks of
// 8x8 triples that are all zero cost one decision. A magnitude is coded against what its decoded neighbours, its parent in
// the coarser band, the other bands and the components before it let expect: low bits that are noise at this scale are
// raw, the rest is unary with adaptive models, long ones end in an Elias-gamma code. After: the context modelling of EBCOT
// / ECECOW reduced to one expected magnitude per component, whose weights were fitted and whose models start trained.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "format/band.h"
#include "format/bit_model.h"
#include "format/rim.h"
#include "format/trained_models.h"

namespace gim {

// The adaptive state of one image; it goes on from level to level.
struct BandModels {
    static constexpr uint32_t kUnary = 14;   // decisions before the escape
    static constexpr uint32_t kScaled = 15;  // first class that has raw bits; it and the next serve all larger ones
    static constexpr uint32_t kClasses = kScaled + 2;  // of expected magnitude
    static constexpr uint32_t kMaxMagnitudeBits = 25;

    explicit BandModels(CoefficientKind coefficients);
    // In the order of the printed tables.
    template <class F>
    void for_each(F&& f);

    CoefficientKind kind;
    std::array<BitModel, 12> block;  // by the blocks left and above, and by what the parent band has there
    // The first component; a later one; the last one where the second is not 0.
    std::array<std::array<std::array<BitModel, kUnary>, kClasses>, 3> magnitude;
    std::array<std::array<BitModel, 2>, kClasses> pair;  // in frames: is any tangential component not 0?
    std::array<BitModel, 32> escape;
    // First or later component; per orientation; by the signs of above, left and parent.
    std::array<std::array<std::array<BitModel, 27>, 3>, 2> sign;
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

// Class of an expected magnitude (in 1/256), and how many raw low bits go with it: half-octaves, and from four units on
// each octave shifts one more bit out, so that what is left has the same distribution.
struct MagnitudeClass {
    uint32_t index = 0, raw_bits = 0;
};
inline MagnitudeClass magnitude_class(uint32_t expected) {
    expected /= 4;
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
    bool code_base(const Band& base) {
        return code_band(base, {Orientation::kHorizontal, nullptr, nullptr, nullptr, kBaseWeights, {}});
    }

    // parents: the bands of the next coarser level, or nullptr. Copies of the rim are zero and not coded.
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

  private:
    // What is known besides the band itself: the band above in the pyramid and those of the same level coded before.
    struct Surroundings {
        Orientation orientation = Orientation::kHorizontal;
        const Band* parent = nullptr;
        const Band* horizontal = nullptr;
        const Band* vertical = nullptr;
        const BandWeights* weights = nullptr;
        SharedRim rim;
    };

    static constexpr int32_t kNothing[3] = {0, 0, 0};

    bool code_band(const Band& band, const Surroundings& around);
    void code_block_flags(const Band& band, const Surroundings& around, uint32_t row);
    void expect(const Surroundings& around, uint32_t row, uint32_t begin, uint32_t end);
    bool code_run(const Band& band, const Surroundings& around, uint32_t row, uint32_t begin, uint32_t end);
    bool code_magnitude(uint32_t set, uint32_t expected, bool not_zero, uint32_t* magnitude);

    Coder& coder_;
    BandModels& models_;
    BandWork work_;
};

// ---- implementation ----

template <class F>
void BandModels::for_each(F&& f) {
    for (BitModel& m : block) f(m);
    for (auto& set : magnitude)
        for (auto& c : set)
            for (BitModel& m : c) f(m);
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

// not_zero: known beforehand.
template <class Coder>
inline bool BandCoder<Coder>::code_magnitude(uint32_t set, uint32_t expected, bool not_zero, uint32_t* value) {
    const MagnitudeClass c = magnitude_class(expected);
    auto& unary = models_.magnitude[set][c.index];
    const uint32_t known = *value;
    const uint32_t known_high = known >> c.raw_bits;
    uint32_t magnitude = not_zero && c.raw_bits == 0 ? 1 : 0;
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
    *value = magnitude;
    return magnitude >> BandModels::kMaxMagnitudeBits == 0;
}

// One flag per block of the block row that begins at `row`.
template <class Coder>
void BandCoder<Coder>::code_block_flags(const Band& band, const Surroundings& around, uint32_t row) {
    const uint32_t blocks = (band.columns + 7) / 8;
    uint32_t left = 1;
    for (uint32_t b = 0; b < blocks; ++b) {
        uint32_t parents = 0;  // triples that are not zero, up to two
        if (around.parent) {
            const uint32_t end = std::min(around.parent->columns, b * 4 + 4);
            for (uint32_t r = row / 2; r < std::min(around.parent->rows, row / 2 + 4); ++r) {
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
        work_.full_above[b] = static_cast<uint8_t>(left);
    }
}

// Weighs the neighbours of columns begin .. end-1 that are known before the row is: in 1/256 of the magnitude that they let
// expect.
template <class Coder>
void BandCoder<Coder>::expect(const Surroundings& around, uint32_t row, uint32_t begin, uint32_t end) {
    const BandWeights &first = around.weights[0], &later = around.weights[1];
    uint32_t* expected = work_.expected + BandWork::kGuard;
    const int32_t* above = work_.above + BandWork::kGuard;
    for (auto i = static_cast<int32_t>(begin * 3); i < static_cast<int32_t>(end * 3); i += 3) {
        for (int32_t k = 0; k < 3; ++k) {
            const BandWeights& w = k == 0 ? first : later;
            expected[i + k] = w.constant + w.above * magnitude_of(above[i + k]) +
                              w.corners * (magnitude_of(above[i + k - 3]) + magnitude_of(above[i + k + 3]));
        }
    }
    if (around.parent && row / 2 < around.parent->rows) {
        const int32_t* from = around.parent->row(row / 2);
        const int32_t* up = row / 2 > 0 ? around.parent->row(row / 2 - 1) : kNothing;
        const int32_t* down = row / 2 + 1 < around.parent->rows ? around.parent->row(row / 2 + 1) : kNothing;
        const uint32_t parents = around.parent->columns, parent_end = std::min((end + 1) / 2, parents);
        for (uint32_t column = begin / 2; column < parent_end; ++column) {
            const int32_t* left = column > 0 ? from + (column - 1) * 3 : kNothing;
            const int32_t* right = column + 1 < parents ? from + (column + 1) * 3 : kNothing;
            const uint32_t i = up == kNothing ? 0 : column * 3, j = down == kNothing ? 0 : column * 3;
            for (uint32_t k = 0; k < 3; ++k) {
                const BandWeights& w = k == 0 ? first : later;
                const uint32_t e = w.parent * magnitude_of(from[column * 3 + k]) +
                                   w.beside_parent * (magnitude_of(up[i + k]) + magnitude_of(down[j + k]) +
                                                      magnitude_of(left[k]) + magnitude_of(right[k]));
                expected[column * 6 + k] += e;
                expected[column * 6 + 3 + k] += e;  // past the end is room
            }
        }
    }
    // A row of another band of the same level, `shift` columns further (-1, 0, 1); it has up to one row or column less, or
    // more.
    const auto add = [&](const Band& other, uint32_t from_row, int32_t shift, uint32_t first_weight,
                         uint32_t later_weight) {
        if (from_row >= other.rows) return;
        const int32_t* from = other.row(from_row);
        const int32_t add_end = std::min(static_cast<int32_t>(end), static_cast<int32_t>(other.columns) - shift);
        for (int32_t i = std::max(static_cast<int32_t>(begin), -shift) * 3; i < add_end * 3; i += 3) {
            expected[i] += first_weight * magnitude_of(from[i + shift * 3]);
            expected[i + 1] += later_weight * magnitude_of(from[i + shift * 3 + 1]);
            expected[i + 2] += later_weight * magnitude_of(from[i + shift * 3 + 2]);
        }
    };
    // Those around the sample: horizontal ones of two rows, vertical ones of two columns.
    if (around.horizontal) {
        for (uint32_t below = 0; below < 2; ++below) {
            add(*around.horizontal, row + below, 0, first.horizontal, later.horizontal);
            if (around.orientation == Orientation::kVertical)
                add(*around.horizontal, row + below, -1, first.horizontal, later.horizontal);
        }
    }
    if (around.vertical) {
        for (int32_t shift = 0; shift < 2; ++shift) add(*around.vertical, row, shift, first.vertical, later.vertical);
    }
}

// Columns begin .. end-1 of a row, all in blocks that are not empty.
template <class Coder>
bool BandCoder<Coder>::code_run(const Band& band, const Surroundings& around, uint32_t row, uint32_t begin,
                                uint32_t end) {
    expect(around, row, begin, end);
    const BandWeights &first = around.weights[0], &later = around.weights[1];
    const int32_t* above = work_.above + BandWork::kGuard;
    int32_t* current = work_.current + BandWork::kGuard;
    const uint32_t* expected = work_.expected + BandWork::kGuard;
    int32_t* values = band.row(row);
    const bool has_parent = around.parent && row / 2 < around.parent->rows;
    const bool shared = static_cast<bool>(around.rim), across = around.orientation == Orientation::kVertical;
    const bool rim_row = shared && !across && (row == 0 || row + 1 == band.rows);
    const auto on_rim = [&](uint32_t column) {
        return rim_row || (shared && across && (column == 0 || column + 1 == band.columns));
    };
    for (uint32_t column = begin; column < end; ++column) {
        const int32_t* parent =
            has_parent && column / 2 < around.parent->columns ? around.parent->row(row / 2) + column / 2 * 3 : kNothing;
        const auto at = static_cast<int32_t>(column * 3);
        if (on_rim(column) && around.rim.is_copy(around.orientation, row, column)) continue;
        const auto code = [&](uint32_t k, uint32_t set, uint32_t e, bool not_zero) {
            const int32_t i = at + static_cast<int32_t>(k);
            uint32_t magnitude = magnitude_of(values[i]);
            if (!code_magnitude(set, e, not_zero, &magnitude)) return false;
            auto& signs = models_.sign[std::min(k, 1u)][static_cast<size_t>(around.orientation)];
            const uint32_t sign = (sign_class(above[i]) * 3 + sign_class(current[i - 3])) * 3 + sign_class(parent[k]);
            const bool negative = magnitude != 0 && coder_.code_bit(signs[sign], values[i] < 0);
            values[i] = current[i] = negative ? -static_cast<int32_t>(magnitude) : static_cast<int32_t>(magnitude);
            return true;
        };
        // Magnitudes of component k on the left and above.
        const auto beside = [&](int32_t k) { return magnitude_of(current[at + k - 3]) + magnitude_of(above[at + k]); };
        const uint32_t beside1 = beside(1), beside2 = beside(2);

        const uint32_t e0 =
            expected[at] + first.left * magnitude_of(current[at - 3]) + first.cross * (beside1 + beside2);
        if (!code(0, 0, e0, false)) return false;

        const uint32_t magnitude0 = magnitude_of(current[at]);
        const uint32_t e1 = expected[at + 1] + later.left * magnitude_of(current[at - 2]) + later.cross * beside2 +
                            later.first * magnitude0;
        uint32_t e2 = expected[at + 2] + later.left * magnitude_of(current[at - 1]) + later.cross * beside1 +
                      later.first * magnitude0;
        const bool paired = models_.kind == CoefficientKind::kInFrames;
        if (paired) {
            const uint32_t any = (values[at + 1] | values[at + 2]) != 0;
            if (!coder_.code_bit(models_.pair[magnitude_class(e1 + e2).index][magnitude0 != 0], any)) {
                current[at + 1] = current[at + 2] = 0;
                continue;
            }
        }
        if (!code(1, 1, e1, false)) return false;
        const uint32_t magnitude1 = magnitude_of(current[at + 1]);
        if (!code(2, magnitude1 != 0 ? 2 : 1, e2 + later.second * magnitude1, paired && magnitude1 == 0)) return false;
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
        if (row % 8 == 0) code_block_flags(band, around, row);
        std::fill_n(work_.current, row_size, 0);
        if constexpr (!Coder::kWrites) std::fill_n(band.row(row), size_t{band.columns} * 3, 0);
        for (uint32_t b = 0; b < blocks;) {
            const uint32_t first = b++;
            if (!work_.full_above[first]) continue;
            while (b < blocks && work_.full_above[b]) ++b;
            if (!code_run(band, around, row, first * 8, std::min(band.columns, b * 8))) return false;
        }
        std::swap(work_.above, work_.current);
    }
    return true;
}

}  // namespace gim

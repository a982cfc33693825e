// Codes an imported image: the mask, then the samples that it defines. Encoder and decoder share this traversal, each with
// its own coder.  spec/gim-format.md, "Rasters".
//
// Samples follow each other row by row. A sample is predicted by linear predictors, as far as the mask leaves their
// neighbours. Each counts by how well it did on the neighbours. A border sample that is one surface point with an earlier
// one is coded as a link to that sample, and most links follow from those of its neighbours. What is left is coded as in
// bands (format/band_code.h). After: the context templates of JBIG; Meyer, Tischer. TMW - a new method for lossless image
// compression. PCS 1997 (blended predictors).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>

#include "format/band_code.h"
#include "format/bit_model.h"
#include "format/chart_ramp.h"

namespace gim {

inline constexpr uint32_t kRasterGroup = 3;  // most channels that are coded together
inline constexpr uint32_t kRasterPredictors = 7;
inline constexpr uint32_t kNoLink = UINT32_MAX;

struct RasterShape {
    uint32_t columns = 0, rows = 0, channels = 0;

    size_t samples() const { return size_t{columns} * rows; }
};

// Channels that are coded together. Positions are the first group, and the only one with links.
struct RasterGroup {
    uint32_t first = 0, count = 0;
    std::array<uint32_t, kRasterGroup> bits{};  // of the values of each channel

    bool has_links() const { return first == 0; }
};

// Arrays of the caller. An encoder fills in `depth` (any value but kUndefined where a sample is defined), `values` and
// `origin`.
struct RasterWork {
    uint8_t* depth = nullptr;          // per sample: kOnBorder, kInside, kUndefined
    int32_t* values = nullptr;         // per sample, all its channels
    uint32_t* point = nullptr;         // per sample: the surface point, numbered by first appearance
    uint32_t* link = nullptr;          // per sample: another sample of its point, or kNoLink
    uint32_t* border = nullptr;        // the border samples, row by row
    uint32_t* errors = nullptr;        // two rows of kRasterPredictors per column
    uint32_t* magnitudes = nullptr;    // two rows of kRasterGroup per column
    const uint32_t* origin = nullptr;  // encoder only, per sample: the first sample of its point
};

template <class Coder>
class RasterCoder {
  public:
    RasterCoder(Coder* coder, const RasterShape& shape, const RasterWork& work)
        : coder_(*coder), shape_(shape), work_(work) {}

    // Codes which samples are defined, and finds the border.
    void code_mask();
    // Codes the values of a group. Returns false if one is larger than its bits allow, or if a link leads nowhere.
    bool code_group(const RasterGroup& group);
    // After the first group: of the glued surface.
    uint32_t point_count() const { return points_; }

  private:
    // The neighbours that come before a sample.
    enum Place : uint32_t {
        kWest,
        kNorth,
        kNorthWest,
        kNorthEast,
        kWest2,
        kNorth2,
        kNorth2West,
        kNorth2East,
        kNorthWest2
    };
    static constexpr uint32_t kPlaces = 9, kBeside = 4;  // the first four touch it

    struct Models {
        BandModels values{CoefficientKind::kPlain};
        std::array<std::array<BitModel, 9>, kRasterGroup> sign;  // by the signs at west and north
        std::array<BitModel, 3> follows;                         // by the number of neighbours that have links
        std::array<BitModel, kBeside> which;
        std::array<BitModel, 2> leaps;  // by whether there are links to follow
        BitModel is_inexact;
    };
    // What is known of a sample before its values are.
    struct Sample {
        uint32_t row = 0, column = 0, index = 0;
        uint32_t defined = 0;                    // bit p: the neighbour at place p is defined
        std::array<uint32_t, kPlaces> places{};  // their indices, where defined
        std::array<int32_t, kRasterGroup> expected{};
        uint32_t usable = 0;  // bit k: predictor k has its neighbours
        std::array<std::array<int32_t, kRasterGroup>, kRasterPredictors> predictions{};
        bool has(Place p) const { return defined >> p & 1; }
    };

    bool is_defined(uint32_t row, uint32_t column) const {
        return row < shape_.rows && column < shape_.columns &&
               work_.depth[size_t{row} * shape_.columns + column] != kUndefined;
    }
    const int32_t* values_of(uint32_t index) const { return work_.values + size_t{index} * shape_.channels + first_; }
    uint32_t* errors_of(uint32_t row, uint32_t column) const {
        return work_.errors + (size_t{row & 1} * shape_.columns + column) * kRasterPredictors;
    }
    uint32_t* magnitudes_of(uint32_t row, uint32_t column) const {
        return work_.magnitudes + (size_t{row & 1} * shape_.columns + column) * kRasterGroup;
    }

    void find_border();
    void look_around(Sample& s) const;
    void predict(const RasterGroup& group, Sample& s) const;
    void blend(const RasterGroup& group, Sample& s) const;
    uint32_t links_to_follow(const Sample& s, std::array<uint32_t, kBeside>& found, uint32_t* linked) const;
    bool code_link(Models& models, const Sample& s, uint32_t* to);
    bool code_values(Models& models, const RasterGroup& group, const Sample& s,
                     const std::array<int32_t, kRasterGroup>& expected, bool is_linked);
    void learn(const RasterGroup& group, const Sample& s);

    Coder& coder_;
    RasterShape shape_;
    RasterWork work_;
    uint32_t first_ = 0;  // channel of the group
    uint32_t points_ = 0;
    uint32_t border_count_ = 0;  // so far
    uint32_t last_ = kNoLink;    // the sample coded last
};

// ---- implementation ----

template <class Coder>
void RasterCoder<Coder>::code_mask() {
    std::array<BitModel, 256> models;
    for (uint32_t r = 0; r < shape_.rows; ++r) {
        for (uint32_t c = 0; c < shape_.columns; ++c) {
            // Rows and columns before the first one wrap around to numbers that are not in the image.
            const uint32_t context = (is_defined(r, c - 1) ? 1u : 0u) | (is_defined(r - 1, c) ? 2u : 0u) |
                                     (is_defined(r - 1, c + 1) ? 4u : 0u) | (is_defined(r - 1, c - 1) ? 8u : 0u) |
                                     (is_defined(r, c - 2) ? 16u : 0u) | (is_defined(r - 2, c) ? 32u : 0u) |
                                     (is_defined(r - 1, c + 2) ? 64u : 0u) | (is_defined(r - 1, c - 2) ? 128u : 0u);
            uint8_t& depth = work_.depth[size_t{r} * shape_.columns + c];
            depth = coder_.code_bit(models[context], Coder::kWrites && depth != kUndefined) ? kInside : kUndefined;
        }
    }
    find_border();
}

template <class Coder>
void RasterCoder<Coder>::find_border() {
    for (uint32_t r = 0; r < shape_.rows; ++r) {
        for (uint32_t c = 0; c < shape_.columns; ++c) {
            if (!is_defined(r, c)) continue;
            const bool is_inside =
                is_defined(r - 1, c) && is_defined(r + 1, c) && is_defined(r, c - 1) && is_defined(r, c + 1);
            work_.depth[size_t{r} * shape_.columns + c] = is_inside ? kInside : kOnBorder;
        }
    }
}

template <class Coder>
void RasterCoder<Coder>::look_around(Sample& s) const {
    constexpr uint8_t kUp[kPlaces] = {0, 1, 1, 1, 0, 2, 2, 2, 1};
    constexpr int8_t kRight[kPlaces] = {-1, 0, -1, 1, -2, 0, -1, 1, -2};
    s.defined = 0;
    for (uint32_t p = 0; p < kPlaces; ++p) {
        if (!is_defined(s.row - kUp[p], s.column + static_cast<uint32_t>(int32_t{kRight[p]}))) continue;
        s.defined |= 1u << p;
        s.places[p] = s.index - kUp[p] * shape_.columns + static_cast<uint32_t>(int32_t{kRight[p]});
    }
}

template <class Coder>
void RasterCoder<Coder>::predict(const RasterGroup& group, Sample& s) const {
    constexpr auto places = [](auto... p) { return (0u | ... | (1u << p)); };
    constexpr uint32_t kNeeds[kRasterPredictors] = {places(kWest, kNorth, kNorthWest),
                                                    places(kWest, kWest2),
                                                    places(kNorth, kNorth2),
                                                    places(kWest, kNorth, kNorthEast),
                                                    places(kNorth, kNorthEast, kNorth2East),
                                                    places(kWest, kNorth, kNorthWest, kNorth2, kNorth2West),
                                                    places(kWest, kNorth, kNorthWest, kWest2, kNorthWest2)};
    std::array<std::array<int32_t, kPlaces>, kRasterGroup> around{};
    for (uint32_t p = 0; p < kPlaces; ++p) {
        if ((s.defined >> p & 1) == 0) continue;
        for (uint32_t k = 0; k < group.count; ++k) around[k][p] = values_of(s.places[p])[k];
    }
    s.usable = 0;
    for (uint32_t i = 0; i < kRasterPredictors; ++i) s.usable |= (kNeeds[i] & ~s.defined) == 0 ? 1u << i : 0u;
    for (uint32_t k = 0; k < group.count; ++k) {  // those that are not usable are not read
        const auto& [w, n, nw, ne, w2, n2, n2w, n2e, nw2] = around[k];
        auto& p = s.predictions;
        p[0][k] = w + n - nw;
        p[1][k] = 2 * w - w2;
        p[2][k] = 2 * n - n2;
        p[3][k] = w + ne - n;
        p[4][k] = n + ne - n2e;
        p[5][k] = w + 2 * (n - nw) - n2 + n2w;
        p[6][k] = n + 2 * (w - nw) - w2 + nw2;
    }
    if (s.usable != 0) {
        blend(group, s);
    } else {
        for (uint32_t k = 0; k < group.count; ++k) {
            const auto& a = around[k];
            s.expected[k] = s.has(kWest) && s.has(kNorth) ? (a[kWest] + a[kNorth]) / 2
                            : s.has(kWest)                ? a[kWest]
                            : s.has(kNorth)               ? a[kNorth]
                            : s.has(kNorthWest)           ? a[kNorthWest]
                            : s.has(kNorthEast)           ? a[kNorthEast]
                            : last_ != kNoLink            ? values_of(last_)[k]
                                                          : int32_t{1} << (group.bits[k] - 1);
        }
    }
    for (uint32_t k = 0; k < group.count; ++k)
        s.expected[k] = std::clamp(s.expected[k], 0, (int32_t{1} << group.bits[k]) - 1);
}

// The mean of the predictions, weighted by 1 / (error around)^2.
template <class Coder>
void RasterCoder<Coder>::blend(const RasterGroup& group, Sample& s) const {
    constexpr uint32_t kDoubt[kBeside] = {3, 3, 2, 2};
    std::array<const uint32_t*, kBeside> near{};
    for (uint32_t p = 0; p < kBeside; ++p) {
        if ((s.defined >> p & 1) == 0) continue;
        near[p] =
            errors_of(p == kWest ? s.row : s.row - 1, s.places[p] - (s.row - (p == kWest ? 0 : 1)) * shape_.columns);
    }
    std::array<uint32_t, kRasterPredictors> errors{};
    uint32_t least = UINT32_MAX;
    for (uint32_t i = 0; i < kRasterPredictors; ++i) {
        errors[i] = 8;
        for (uint32_t p = 0; p < kBeside; ++p) errors[i] += near[p] ? kDoubt[p] * near[p][i] : 0;
        if ((s.usable >> i & 1) != 0) least = std::min(least, errors[i]);
    }
    const int shift = std::max(static_cast<int>(std::bit_width(least)) - 8, 0);
    std::array<int64_t, kRasterGroup> sums{};
    int64_t weights = 0;
    for (uint32_t i = 0; i < kRasterPredictors; ++i) {
        if ((s.usable >> i & 1) == 0) continue;
        const uint32_t error = std::min(errors[i] >> shift, 4096u);
        const int64_t weight = (1u << 24) / (error * error);
        weights += weight;
        for (uint32_t k = 0; k < group.count; ++k) sums[k] += weight * s.predictions[i][k];
    }
    for (uint32_t k = 0; k < group.count; ++k) {
        const int64_t sum = std::max(2 * sums[k] + weights, int64_t{0});
        s.expected[k] = static_cast<int32_t>(std::min(sum / (2 * weights), int64_t{1} << 24));
    }
}

// Finds the points beside those that the neighbours link to, nearest to what is expected first. Each point counts once.
template <class Coder>
uint32_t RasterCoder<Coder>::links_to_follow(const Sample& s, std::array<uint32_t, kBeside>& found,
                                             uint32_t* linked) const {
    std::array<uint32_t, kBeside> distances{};
    uint32_t count = 0;
    *linked = 0;
    const auto consider = [&](uint32_t row, uint32_t column) {
        if (!is_defined(row, column)) return;
        const uint32_t index = row * shape_.columns + column;
        if (index >= s.index || work_.depth[index] != kOnBorder) return;
        uint32_t distance = 0;
        for (uint32_t k = 0; k < kRasterGroup; ++k)
            distance += static_cast<uint32_t>(std::abs(values_of(index)[k] - s.expected[k]));
        for (uint32_t j = 0; j < count; ++j) {
            if (work_.point[found[j]] == work_.point[index]) return;
        }
        uint32_t j = count < kBeside ? count++ : kBeside;
        for (; j > 0 && distance < distances[j - 1]; --j) {
            if (j == kBeside) continue;
            found[j] = found[j - 1];
            distances[j] = distances[j - 1];
        }
        if (j == kBeside) return;
        found[j] = index;
        distances[j] = distance;
    };
    for (uint32_t p = 0; p < kBeside; ++p) {
        if ((s.defined >> p & 1) == 0 || work_.link[s.places[p]] == kNoLink) continue;
        ++*linked;
        const uint32_t row = work_.link[s.places[p]] / shape_.columns,
                       column = work_.link[s.places[p]] % shape_.columns;
        for (uint32_t r = row - 1; r != row + 2; ++r) {
            for (uint32_t c = column - 1; c != column + 2; ++c) consider(r, c);
        }
    }
    return count;
}

// *to receives the sample that the link leads to, or kNoLink.
template <class Coder>
bool RasterCoder<Coder>::code_link(Models& models, const Sample& s, uint32_t* to) {
    *to = kNoLink;
    uint32_t target = kNoLink;  // what an encoder wants
    if constexpr (Coder::kWrites) target = work_.origin[s.index] == s.index ? kNoLink : work_.origin[s.index];
    std::array<uint32_t, kBeside> found{};
    uint32_t linked = 0;
    const uint32_t count = links_to_follow(s, found, &linked);
    if (count > 0) {
        uint32_t which = count;
        if constexpr (Coder::kWrites) {
            for (uint32_t j = 0; j < count && target != kNoLink; ++j)
                if (work_.point[found[j]] == work_.point[target]) which = j;
        }
        if (coder_.code_bit(models.follows[std::min(linked, 3u) - 1], which < count)) {
            uint32_t j = 0;
            while (j + 1 < count && coder_.code_bit(models.which[j], which > j)) ++j;
            *to = found[j];
            return true;
        }
    }
    if (border_count_ == 0 || !coder_.code_bit(models.leaps[count > 0], target != kNoLink)) return true;
    uint32_t place = 0;
    if constexpr (Coder::kWrites)
        place =
            static_cast<uint32_t>(std::lower_bound(work_.border, work_.border + border_count_, target) - work_.border);
    place = coder_.code_raw(place & 0x1FFF, std::min<uint32_t>(std::bit_width(border_count_ - 1), 13)) |
            coder_.code_raw(place >> 13, std::max<uint32_t>(std::bit_width(border_count_ - 1), 13) - 13) << 13;
    if (place >= border_count_) return false;
    *to = work_.border[place];
    return true;
}

template <class Coder>
bool RasterCoder<Coder>::code_values(Models& models, const RasterGroup& group, const Sample& s,
                                     const std::array<int32_t, kRasterGroup>& expected, bool is_linked) {
    int32_t* values = work_.values + size_t{s.index} * shape_.channels + first_;
    uint32_t* magnitudes = magnitudes_of(s.row, s.column);
    std::array<const uint32_t*, kBeside> near{};
    const uint32_t* any = nullptr;  // stands for neighbours that are missing
    for (uint32_t p = kBeside; p-- > 0;) {
        if ((s.defined >> p & 1) == 0) continue;
        const uint32_t row = p == kWest ? s.row : s.row - 1;
        any = near[p] = magnitudes_of(row, s.places[p] - row * shape_.columns);
    }
    const auto magnitude_at = [&](uint32_t p, uint32_t k) {
        const uint32_t* m = near[p] ? near[p] : any;
        return m ? m[k] & 0x7FFFFFFF : 384u;
    };
    const auto sign_at = [&](uint32_t p, uint32_t k) {
        return !near[p] || near[p][k] == 0 ? 0u : near[p][k] >> 31 ? 2u : 1u;
    };
    std::array<uint32_t, kRasterGroup> found{};
    for (uint32_t k = 0; k < group.count; ++k) {
        uint32_t e = 64;
        if (!is_linked) {
            e = 50 * (magnitude_at(kWest, k) + magnitude_at(kNorth, k)) +
                25 * (magnitude_at(kNorthWest, k) + magnitude_at(kNorthEast, k)) + 200;
            if (k > 0) e = e / 2 + 90 * found[0];
            if (k > 1) e += 50 * found[1];
        }
        const int32_t rest = Coder::kWrites ? values[k] - expected[k] : 0;
        uint32_t magnitude = Coder::kWrites ? static_cast<uint32_t>(std::abs(rest)) : 0;
        if (!code_magnitude(coder_, models.values, k, e, false, &magnitude)) return false;
        bool is_negative = false;
        if (magnitude != 0)
            is_negative = coder_.code_bit(models.sign[k][3 * sign_at(kWest, k) + sign_at(kNorth, k)], rest < 0) != 0;
        const int32_t value = expected[k] + (is_negative ? -1 : 1) * static_cast<int32_t>(magnitude);
        if (value < 0 || value >> group.bits[k] != 0) return false;
        found[k] = magnitude;
        values[k] = value;
        magnitudes[k] = magnitude | (is_negative ? 0x80000000 : 0);
    }
    return true;
}

// Keeps how well each predictor did.
template <class Coder>
void RasterCoder<Coder>::learn(const RasterGroup& group, const Sample& s) {
    const int32_t* values = values_of(s.index);
    const auto error_of = [&](const std::array<int32_t, kRasterGroup>& prediction) {
        uint32_t error = 0;
        for (uint32_t k = 0; k < group.count; ++k) error += static_cast<uint32_t>(std::abs(values[k] - prediction[k]));
        return error;
    };
    uint32_t* errors = errors_of(s.row, s.column);
    const uint32_t blended = error_of(s.expected);
    for (uint32_t i = 0; i < kRasterPredictors; ++i)
        errors[i] = (s.usable >> i & 1) != 0 ? error_of(s.predictions[i]) : blended;
}

template <class Coder>
bool RasterCoder<Coder>::code_group(const RasterGroup& group) {
    Models models;
    first_ = group.first;
    last_ = kNoLink;
    Sample s;
    for (s.row = 0, s.index = 0; s.row < shape_.rows; ++s.row) {
        for (s.column = 0; s.column < shape_.columns; ++s.column, ++s.index) {
            if (work_.depth[s.index] == kUndefined) continue;
            look_around(s);
            predict(group, s);
            uint32_t to = kNoLink;
            bool is_copy = false;
            std::array<int32_t, kRasterGroup> expected = s.expected;
            if (group.has_links()) {
                work_.link[s.index] = kNoLink;
                if (work_.depth[s.index] == kOnBorder) {
                    if (!code_link(models, s, &to)) return false;
                    work_.border[border_count_++] = s.index;
                }
                work_.point[s.index] = to == kNoLink ? points_++ : work_.point[to];
            }
            if (to != kNoLink) {
                work_.link[s.index] = to;
                if (work_.link[to] == kNoLink) work_.link[to] = s.index;
                int32_t* values = work_.values + size_t{s.index} * shape_.channels + first_;
                const int32_t* others = values_of(to);
                std::copy_n(others, group.count, expected.begin());
                is_copy = coder_.code_bit(models.is_inexact,
                                          Coder::kWrites && !std::equal(others, others + group.count, values)) == 0;
                if (is_copy) std::copy_n(others, group.count, values);
            }
            if (!is_copy && !code_values(models, group, s, expected, to != kNoLink)) return false;
            if (to != kNoLink) {
                for (uint32_t k = 0; k < group.count; ++k) {
                    const int32_t rest = values_of(s.index)[k] - s.expected[k];
                    magnitudes_of(s.row, s.column)[k] =
                        static_cast<uint32_t>(std::abs(rest)) | (rest < 0 ? 0x80000000 : 0);
                }
            }
            learn(group, s);
            last_ = s.index;
        }
    }
    return true;
}

}  // namespace gim

#include "decoder/pyramid/synthesis.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace gim {
namespace {

// Synthesis undoes the steps from the last to the first. The last one changed the low samples.
template <class Wavelet>
constexpr int low_step(int i) {
    return Wavelet::kSteps - 1 - 2 * i;
}

bool any_of(const int32_t* values, size_t count) {
    int32_t all = 0;
    for (size_t i = 0; i < count; ++i) all |= values[i];
    return all != 0;
}

// Loads rows of the three bands as Samples: integers as they are, or dequantized. load() returns false if all are zero.
class IntegerDetails {
  public:
    IntegerDetails(const int32_t*, uint32_t, uint32_t, const LevelBands& bands, const DetailSteps&, const SharedRim&)
        : bands_(bands) {}
    bool load(Orientation orientation, uint32_t row, int32_t* out) {
        const Band& band = bands_.of(orientation);
        std::copy_n(band.row(row), size_t{band.columns} * 3, out);
        return any_of(out, size_t{band.columns} * 3);
    }

  private:
    const LevelBands& bands_;
};

class LossyDetails {
  public:
    LossyDetails(const float* low, uint32_t low_columns, uint32_t low_rows, const LevelBands& bands,
                 const DetailSteps& steps, const SharedRim& rim)
        : bands_(bands), steps_(steps), rim_(rim), frames_(low, low_columns, low_rows, steps.cell_area) {}
    bool load(Orientation orientation, uint32_t row, float* out) {
        const Band& band = bands_.of(orientation);
        if (steps_.in_frames) return load_framed_row(orientation, row, band, out);
        const int32_t* values = band.row(row);
        const size_t count = size_t{band.columns} * 3;
        const float step = steps_.of(orientation);
        for (size_t i = 0; i < count; ++i) out[i] = dequantize(values[i], step);
        return any_of(values, count);
    }

  private:
    static constexpr uint32_t kLanes = 64, kBlock = 16;

    // Most details are zero. They need no frame, and most blocks of them are skipped. Copies are stored as zeros.
    bool load_framed_row(Orientation orientation, uint32_t row, const Band& band, float* out) {
        std::fill_n(out, size_t{band.columns} * 3, 0.0f);
        const int32_t* values = band.row(row);
        bool any = false;
        const auto write = [&] {
            any = any || count_ > 0;
            write_gathered(orientation, out);
        };
        for (uint32_t begin = 0; begin < band.columns; begin += kBlock) {
            const uint32_t end = std::min(begin + kBlock, band.columns);
            if (end - begin == kBlock && !any_of(values + 3 * size_t{begin}, 3 * kBlock)) continue;
            for (uint32_t column = begin; column < end; ++column) {
                const int32_t* v = values + 3 * size_t{column};
                columns_[count_] = column;
                count_ += (v[0] | v[1] | v[2]) != 0;
            }
            if (count_ <= kLanes - kBlock) continue;
            gather(orientation, row, columns_, count_, 0);
            write();
        }
        gather(orientation, row, columns_, count_, 0);
        for_each_copy(orientation, row, band, [&](uint32_t column) {
            const DetailPlace from = rim_.source_of(orientation, row, column);
            if (!any_of(bands_.of(from.orientation).row(from.row) + 3 * size_t{from.column}, 3)) return;
            if (count_ == kLanes) write();
            gather(from.orientation, from.row, &from.column, 1, count_);
            columns_[count_++] = column;
        });
        write();
        return any;
    }

    // Takes values and tangents of the details in some columns of a row into lanes from `first` on.
    void gather(Orientation orientation, uint32_t row, const uint32_t* columns, uint32_t count, uint32_t first) {
        frames_.find_tangents(orientation, row, columns, count, lanes_, first);
        const int32_t* values = bands_.of(orientation).row(row);
        for (uint32_t i = 0; i < count; ++i)
            for (uint32_t k = 0; k < 3; ++k) values_[k][first + i] = values[3 * size_t{columns[i]} + k];
    }

    // Writes the gathered details into their columns of a row. Copies have the steps of their sources.
    void write_gathered(Orientation orientation, float* out) {
        if (count_ == 0) return;
        // A few stale lanes more are cheaper than the remainder of a loop.
        const uint32_t rounded = (count_ + 3) / 4 * 4;
        frames_.make_frames(lanes_, rounded);
        const float tangential = tangential_step(steps_, orientation);
        const auto& axis = lanes_.axis;
        for (uint32_t i = 0; i < rounded; ++i) {
            const float a = dequantize(values_[0][i], normal_step(steps_, orientation, lanes_.scale[i]));
            const float b = dequantize(values_[1][i], tangential), c = dequantize(values_[2][i], tangential);
            for (uint32_t k = 0; k < 3; ++k) details_[k][i] = dot(axis[0][k][i], a, axis[1][k][i], b, axis[2][k][i], c);
        }
        for (uint32_t i = 0; i < count_; ++i)
            for (uint32_t k = 0; k < 3; ++k) out[3 * size_t{columns_[i]} + k] = details_[k][i];
        count_ = 0;
    }

    // Calls f(column) for each copy in a row of that band.
    template <class F>
    void for_each_copy(Orientation orientation, uint32_t row, const Band& band, const F& f) {
        if (!rim_ || orientation == Orientation::kDiagonal) return;
        const bool all = orientation == Orientation::kHorizontal && (row == 0 || row + 1 == band.rows);
        if (!all && orientation == Orientation::kHorizontal) return;
        const uint32_t next = all ? 1 : std::max(band.columns - 1, 1u);
        for (uint32_t column = 0; column < band.columns; column += next)
            if (rim_.is_copy(orientation, row, column)) f(column);
    }

    const LevelBands& bands_;
    const DetailSteps& steps_;
    const SharedRim& rim_;
    FrameField frames_;
    uint32_t count_ = 0;  // lanes in use
    uint32_t columns_[kLanes];
    DetailLanes<kLanes> lanes_;
    int32_t values_[3][kLanes] = {};
    float details_[3][kLanes];
};

template <class Wavelet>
struct DetailsOf {
    using Type = IntegerDetails;
};
template <>
struct DetailsOf<Irreversible97> {
    using Type = LossyDetails;
};

void load_low(const int32_t* low, size_t count, int32_t* row) { std::copy_n(low, count, row); }
void load_low(const float* low, size_t count, float* row) {
    for (size_t i = 0; i < count; ++i) row[i] = low[i] * Irreversible97::kLowGain;
}

// Writes low and high triples in turn.
template <class Sample>
void interleave(size_t lows, size_t highs, const Sample* low, const Sample* high, Sample* __restrict row) {
    // Copies four numbers at a time: the next triple covers the fourth. The last pair may have no next triple.
    for (size_t i = 0; i + 1 < highs; ++i) {
        std::memcpy(row + 6 * i, low + 3 * i, 4 * sizeof(Sample));
        std::memcpy(row + 6 * i + 3, high + 3 * i, 4 * sizeof(Sample));
    }
    std::copy_n(low + 3 * (highs - 1), 3, row + 6 * (highs - 1));
    std::copy_n(high + 3 * (highs - 1), 3, row + 6 * (highs - 1) + 3);
    if (lows > highs) std::copy_n(low + 3 * highs, 3, row + 6 * highs);
}

// A row as low and high triples: as many low ones as high ones, or one more. Both have room for a triple behind, `high`
// also before.
template <class Sample>
struct SplitRow {
    size_t lows, highs;
    Sample *low, *high;
    bool any_high = true;  // false if the high ones are all zero
};

// Undoes the horizontal steps and writes the row.
template <class Wavelet, class Keeps>
void synthesize_row(const SplitRow<typename Wavelet::Sample>& from, typename Wavelet::Sample* row, const Keeps& keeps) {
    const auto [lows, highs, low, high, any_high] = from;
    for (int i = 0; i < Wavelet::kSteps / 2; ++i) {
        // Zeros change nothing in the first step: its factor is positive, and x - 0 is x, also for -0.
        if (i > 0 || any_high)
            lift_lows<Wavelet, Direction::kSynthesis>(low_step<Wavelet>(i), lows, highs, low, high, keeps);
        std::copy_n(low + 3 * (lows - 1), 3, low + 3 * lows);
        lift_row<Wavelet, Direction::kSynthesis>(low_step<Wavelet>(i) - 1, high, low, low + 3, 3 * highs);
    }
    interleave(lows, highs, low, high, row);
}

// Picks the wavelet by type, and what is kept by the rim.
template <class Sample>
void synthesize_row_of(const SharedRim& rim, uint32_t row, uint32_t rows, const SplitRow<Sample>& from, Sample* out) {
    if constexpr (std::is_same_v<Sample, Reversible53::Sample>) {
        synthesize_row<Reversible53>(from, out, KeepsNone{});
    } else if (!rim) {
        synthesize_row<Irreversible97>(from, out, KeepsNone{});
    } else if (row == 0 || row + 1 == rows) {
        synthesize_row<Irreversible97>(from, out, KeepsOfRow{rim, row, rows});
    } else {
        synthesize_row<Irreversible97>(from, out, KeepsEnds{});
    }
}

// Undoes the vertical steps. Each runs as soon as its rows are ready, while they are still in the cache.
template <class Wavelet>
class VerticalSynthesis {
  public:
    using Sample = typename Wavelet::Sample;

    VerticalSynthesis(Sample* image, uint32_t columns, uint32_t rows, const SharedRim& rim)
        : image_(image),
          rim_(rim),
          width_(3 * size_t{columns}),
          lows_(low_count(rows)),
          highs_(high_count(rows)),
          lifted_(lifted_lows(low_count(rows), static_cast<bool>(rim))) {}

    // Goes on, now that rows up to 2i+1 (i < highs) or all rows (i == highs) are there.
    void advance(ptrdiff_t i) {
        step(0, i);
        if (i == highs_) {
            for (int k = 1; k < Wavelet::kSteps / 2; ++k) step(k, highs_);
        }
    }

  private:
    // Runs pair k of steps on low row i. Pair k runs k rows behind pair 0.
    void step(int k, ptrdiff_t i) {
        if (i < 0) return;
        const int s = low_step<Wavelet>(k);
        if (i > 0 && i < highs_ && is_lifted(i)) {
            lift_low_and_high(s, i);
        } else {
            if (i < lows_) lift_low(s, i);
            if (i > 0) lift_high(s - 1, i - 1);
        }
        if (k + 1 < Wavelet::kSteps / 2) step(k + 1, i - 1);
    }
    // Lifts low row i and high row i-1 at once; all the rows differ.
    void lift_low_and_high(int s, ptrdiff_t i) {
        Sample *target = low(i), *high_target = high(i - 1);
        const Sample *before = low(i - 1), *behind = high(i);
        const auto [begin, end] = lifted_part(rim_, static_cast<uint32_t>(2 * i), width_);
        lift_row_pair<Wavelet, Direction::kSynthesis>(s, target + begin, high_target + begin, behind + begin,
                                                      before + begin, end - begin);
        const auto lift_kept = [&](size_t from, size_t count) {
            lift_end<Wavelet, Direction::kSynthesis>(s, target + from, count);
            lift_row<Wavelet, Direction::kSynthesis>(s - 1, high_target + from, before + from, target + from, count);
        };
        if (begin > 0) lift_kept(0, begin);
        if (end < width_) lift_kept(end, width_ - end);
    }
    bool is_lifted(ptrdiff_t i) const {
        return i >= static_cast<ptrdiff_t>(lifted_.begin) && i < static_cast<ptrdiff_t>(lifted_.end);
    }
    Sample* low(ptrdiff_t i) { return image_ + static_cast<size_t>(2 * std::min(i, lows_ - 1)) * width_; }
    Sample* high(ptrdiff_t i) {
        return image_ + static_cast<size_t>(2 * std::clamp<ptrdiff_t>(i, 0, highs_ - 1) + 1) * width_;
    }
    void lift_low(int s, ptrdiff_t i) {
        if (!is_lifted(i))
            lift_end<Wavelet, Direction::kSynthesis>(s, low(i), width_);
        else
            lift_low_row<Wavelet, Direction::kSynthesis>(s, low(i), high(i - 1), high(i), width_, rim_,
                                                         static_cast<uint32_t>(2 * i));
    }
    void lift_high(int s, ptrdiff_t i) {
        lift_row<Wavelet, Direction::kSynthesis>(s, high(i), low(i), low(i + 1), width_);
    }

    Sample* image_;
    const SharedRim& rim_;
    size_t width_;
    ptrdiff_t lows_, highs_;
    LiftedRange lifted_;
};

}  // namespace

template <class Wavelet>
void synthesize(uint32_t columns, uint32_t rows, const typename Wavelet::Sample* low, const LevelBands& bands,
                const DetailSteps& steps, typename Wavelet::Sample* work, typename Wavelet::Sample* image,
                const SharedRim& rim) {
    const size_t lows = low_count(columns), highs = high_count(columns), width = size_t{columns} * 3;
    using Sample = typename Wavelet::Sample;
    Sample* low_row = work;
    Sample* high_row = work + 3 * (lows + 1) + 3;
    VerticalSynthesis<Wavelet> vertical(image, columns, rows, rim);
    typename DetailsOf<Wavelet>::Type details(low, low_count(columns), low_count(rows), bands, steps, rim);
    for (uint32_t i = 0; i <= rows / 2; ++i) {
        if (2 * i < rows) {
            load_low(low + i * 3 * lows, 3 * lows, low_row);
            const bool any = details.load(Orientation::kHorizontal, i, high_row);
            synthesize_row_of(rim, 2 * i, rows, {lows, highs, low_row, high_row, any}, image + 2 * i * width);
        }
        if (2 * i + 1 < rows) {
            const bool any_low = details.load(Orientation::kVertical, i, low_row);
            const bool any_high = details.load(Orientation::kDiagonal, i, high_row);
            Sample* row = image + (2 * i + 1) * width;
            if (any_low || any_high)
                synthesize_row_of(rim, 2 * i + 1, rows, {lows, highs, low_row, high_row, any_high}, row);
            else
                std::fill_n(row, width, Sample{0});  // what lifting makes of zeros
        }
        vertical.advance(static_cast<ptrdiff_t>(i));
    }
}

template void synthesize<Reversible53>(uint32_t, uint32_t, const int32_t*, const LevelBands&, const DetailSteps&,
                                       int32_t*, int32_t*, const SharedRim&);
template void synthesize<Irreversible97>(uint32_t, uint32_t, const float*, const LevelBands&, const DetailSteps&,
                                         float*, float*, const SharedRim&);

}  // namespace gim

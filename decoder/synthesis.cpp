#include "decoder/synthesis.h"

#include <algorithm>
#include <type_traits>

namespace gim {
namespace {

template <class Wavelet>
constexpr int low_step(
    int i) {  // synthesis undoes the steps from the last to the first; the last one changed the low samples
    return Wavelet::kSteps - 1 - 2 * i;
}

// Rows of the three bands as Samples: integers as they are, or dequantized.
class IntegerDetails {
  public:
    IntegerDetails(const int32_t*, uint32_t, uint32_t, const LevelBands& bands, const DetailSteps&, const SharedRim&)
        : bands_(bands) {}
    void load(Orientation orientation, uint32_t row, int32_t* out) const {
        const Band& band = bands_.of(orientation);
        std::copy_n(band.row(row), size_t{band.columns} * 3, out);
    }

  private:
    const LevelBands& bands_;
};

class LossyDetails {
  public:
    LossyDetails(const float* low, uint32_t low_columns, uint32_t low_rows, const LevelBands& bands,
                 const DetailSteps& steps, const SharedRim& rim)
        : bands_(bands), steps_(steps), rim_(rim), frames_(low, low_columns, low_rows, steps.cell_area) {}
    void load(Orientation orientation, uint32_t row, float* out) const {
        const Band& band = bands_.of(orientation);
        const int32_t* values = band.row(row);
        if (steps_.in_frames) {
            for (uint32_t column = 0; column < band.columns; ++column)
                load_framed(orientation, row, column, out + 3 * size_t{column});
            if (rim_) load_copies(orientation, row, band, out);
        } else {
            const float step = steps_.of(orientation);
            for (size_t i = 0; i < size_t{band.columns} * 3; ++i) out[i] = dequantize(values[i], step);
        }
    }

  private:
    // Most details are zero: those need no frame.
    void load_framed(Orientation orientation, uint32_t row, uint32_t column, float* out) const {
        const int32_t* values = bands_.of(orientation).row(row) + 3 * size_t{column};
        if ((values[0] | values[1] | values[2]) == 0) {
            std::fill_n(out, 3, 0.0f);
            return;
        }
        const DetailFrame frame = frames_.at(orientation, row, column);
        float step[3], local[3];
        steps_in(frame, steps_, orientation, step);
        for (int k = 0; k < 3; ++k) local[k] = dequantize(values[k], step[k]);
        out_of_frame(frame, local, out);
    }

    // Of a row of that band.
    void load_copies(Orientation orientation, uint32_t row, const Band& band, float* out) const {
        const auto load = [&](uint32_t column) {
            if (!rim_.is_copy(orientation, row, column)) return;
            const DetailPlace from = rim_.source_of(orientation, row, column);
            load_framed(from.orientation, from.row, from.column, out + 3 * size_t{column});
        };
        if (orientation == Orientation::kHorizontal && (row == 0 || row + 1 == band.rows)) {
            for (uint32_t column = 0; column < band.columns; ++column) load(column);
        } else if (orientation == Orientation::kVertical) {
            load(0);
            load(band.columns - 1);
        }
    }

    const LevelBands& bands_;
    const DetailSteps& steps_;
    const SharedRim& rim_;
    FrameField frames_;
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

// Undoes the horizontal steps on one row given as low and high triples, as many low ones as high ones or one more. Both have
// room for a triple behind, high also before. Writes the row.
template <class Wavelet, class Keeps>
void synthesize_row(size_t lows, size_t highs, typename Wavelet::Sample* low, typename Wavelet::Sample* high,
                    typename Wavelet::Sample* row, const Keeps& keeps) {
    for (int i = 0; i < Wavelet::kSteps / 2; ++i) {
        lift_lows<Wavelet, Direction::kSynthesis>(low_step<Wavelet>(i), lows, highs, low, high, keeps);
        std::copy_n(low + 3 * (lows - 1), 3, low + 3 * lows);
        lift_row<Wavelet, Direction::kSynthesis>(low_step<Wavelet>(i) - 1, high, low, low + 3, 3 * highs);
    }
    for (size_t i = 0; i < highs; ++i) {
        for (size_t k = 0; k < 3; ++k) row[6 * i + k] = low[3 * i + k];
        for (size_t k = 0; k < 3; ++k) row[6 * i + 3 + k] = high[3 * i + k];
    }
    if (lows > highs) std::copy_n(low + 3 * highs, 3, row + 6 * highs);
}

// Wavelet and what is kept are the rim's.
template <class Sample>
void synthesize_row_of(const SharedRim& rim, uint32_t row, uint32_t rows, size_t lows, size_t highs, Sample* low,
                       Sample* high, Sample* out) {
    if constexpr (std::is_same_v<Sample, Reversible53::Sample>) {
        synthesize_row<Reversible53>(lows, highs, low, high, out, KeepsNone{});
    } else if (!rim) {
        synthesize_row<Irreversible97>(lows, highs, low, high, out, KeepsNone{});
    } else if (row == 0 || row + 1 == rows) {
        synthesize_row<Irreversible97>(lows, highs, low, high, out, KeepsOfRow{rim, row, rows});
    } else {
        synthesize_row<Irreversible97>(lows, highs, low, high, out, KeepsEnds{});
    }
}

// Vertical steps, each as early as its rows are ready so that they are still in the cache.
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

    // Rows up to 2i+1 (i < highs) or all rows (i == highs) are there.
    void advance(ptrdiff_t i) {
        step(0, i);
        if (i == highs_) {
            for (int k = 1; k < Wavelet::kSteps / 2; ++k) step(k, highs_);
        }
    }

  private:
    // Pair k of steps, ready for low row i of its first step: pair k runs k rows behind pair 0.
    void step(int k, ptrdiff_t i) {
        if (i < 0) return;
        if (i < lows_) lift_low(low_step<Wavelet>(k), i);
        if (i > 0) lift_high(low_step<Wavelet>(k) - 1, i - 1);
        if (k + 1 < Wavelet::kSteps / 2) step(k + 1, i - 1);
    }
    Sample* low(ptrdiff_t i) { return image_ + static_cast<size_t>(2 * std::min(i, lows_ - 1)) * width_; }
    Sample* high(ptrdiff_t i) {
        return image_ + static_cast<size_t>(2 * std::clamp<ptrdiff_t>(i, 0, highs_ - 1) + 1) * width_;
    }
    void lift_low(int s, ptrdiff_t i) {
        if (i < static_cast<ptrdiff_t>(lifted_.begin) || i >= static_cast<ptrdiff_t>(lifted_.end))
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
    LiftedLows lifted_;
};

}  // namespace

template <class Wavelet>
void synthesize(uint32_t columns, uint32_t rows, const typename Wavelet::Sample* low, const LevelBands& bands,
                const DetailSteps& steps, typename Wavelet::Sample* work, typename Wavelet::Sample* image,
                const SharedRim& rim) {
    const size_t lows = low_count(columns), highs = high_count(columns), width = size_t{columns} * 3;
    auto* low_row = work;
    auto* high_row = work + 3 * (lows + 1) + 3;
    VerticalSynthesis<Wavelet> vertical(image, columns, rows, rim);
    const typename DetailsOf<Wavelet>::Type details(low, low_count(columns), low_count(rows), bands, steps, rim);
    for (uint32_t i = 0; i <= rows / 2; ++i) {
        if (2 * i < rows) {
            load_low(low + i * 3 * lows, 3 * lows, low_row);
            details.load(Orientation::kHorizontal, i, high_row);
            synthesize_row_of(rim, 2 * i, rows, lows, highs, low_row, high_row, image + 2 * i * width);
        }
        if (2 * i + 1 < rows) {
            details.load(Orientation::kVertical, i, low_row);
            details.load(Orientation::kDiagonal, i, high_row);
            synthesize_row_of(rim, 2 * i + 1, rows, lows, highs, low_row, high_row, image + (2 * i + 1) * width);
        }
        vertical.advance(static_cast<ptrdiff_t>(i));
    }
}

template void synthesize<Reversible53>(uint32_t, uint32_t, const int32_t*, const LevelBands&, const DetailSteps&,
                                       int32_t*, int32_t*, const SharedRim&);
template void synthesize<Irreversible97>(uint32_t, uint32_t, const float*, const LevelBands&, const DetailSteps&,
                                         float*, float*, const SharedRim&);

}  // namespace gim

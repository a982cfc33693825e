#include "decoder/pyramid/synthesis.h"

#include <algorithm>

namespace gim {
namespace {

// Loads rows of the three bands as numbers: integers as they are, or dequantized. load() returns false if all are zero.
class DetailRows {
  public:
    DetailRows(bool integers, const Number* low, uint32_t low_columns, uint32_t low_rows, const LevelBands& bands,
               const DetailSteps& steps, const SharedRim& rim)
        : integers_(integers),
          bands_(bands),
          steps_(steps),
          rim_(rim),
          frames_(reinterpret_cast<const float*>(low), low_columns, low_rows, steps.cell_area) {}
    bool load(Orientation orientation, uint32_t row, Number* out) {
        const Band& band = bands_.of(orientation);
        const int32_t* values = band.row(row);
        const size_t count = size_t{band.columns} * 3;
        auto* floats = reinterpret_cast<float*>(out);
        if (!integers_ && steps_.in_frames) return load_framed_row(orientation, row, band, floats);
        if (integers_)
            std::copy_n(values, count, reinterpret_cast<int32_t*>(out));
        else
            dequantize_row(values, count, steps_.of(orientation), floats);
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
        const size_t rounded = lanes::whole_groups<kLanes>(count_);
        frames_.make_frames(lanes_, count_);
        const float tangential = tangential_step(steps_, orientation);
        const auto& axis = lanes_.axis;
        for (size_t i = 0; i < rounded; ++i) {
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

    bool integers_;
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

// A row as low and high triples: as many low ones as high ones, or one more. Both have room for a triple behind, `high`
// also before.
struct SplitRow {
    size_t lows, highs;
    Number *low, *high;
    bool any_high = true;  // false if the high ones are all zero
};

// Undoes the horizontal steps of the rows of an image.
class HorizontalSynthesis {
  public:
    HorizontalSynthesis(const RowLifting& lifting, uint32_t rows, const SharedRim& rim)
        : lifting_(lifting), rows_(rows), rim_(rim) {}

    void write(const SplitRow& from, uint32_t row, Number* out) const {
        const auto [lows, highs, low, high, any_high] = from;
        for (int i = 0; i < lifting_.pairs(); ++i) {
            const int step = lifting_.low_step(i);
            // Zeros change nothing in the first step: its factor is positive, and x - 0 is x, also for -0.
            if (i > 0 || any_high) undo_lows(step, from, row);
            std::copy_n(low + 3 * (lows - 1), 3, low + 3 * lows);
            lifting_.undo(step - 1, high, low, low + 3, 3 * highs);
        }
        interleave(lows, highs, low, high, out);
    }

  private:
    // Cut-nodes on the rim end runs of their own; inner rows keep only their ends.
    void undo_lows(int step, const SplitRow& from, uint32_t row) const {
        const size_t lows = from.lows, highs = from.highs;
        Number *low = from.low, *high = from.high;
        std::copy_n(high, 3, high - 3);
        std::copy_n(high + 3 * (highs - 1), 3, high + 3 * highs);
        const auto undo = [&](size_t first, size_t last) {
            if (first < last)
                lifting_.undo(step, low + 3 * first, high + 3 * first - 3, high + 3 * first, 3 * (last - first));
        };
        const auto [begin, end] = lifted_lows(lows, static_cast<bool>(rim_));
        if (begin > 0) lifting_.undo_end(step, low, 3);
        size_t first = begin;
        for (size_t i = begin; rim_ && (row == 0 || row + 1 == rows_) && i < end; ++i) {
            if (!rim_.is_run_end(row, static_cast<uint32_t>(2 * i))) continue;
            undo(first, i);
            lifting_.undo_end(step, low + 3 * i, 3);
            first = i + 1;
        }
        undo(first, end);
        if (end < lows) lifting_.undo_end(step, low + 3 * end, 3);
    }

    const RowLifting& lifting_;
    uint32_t rows_;
    const SharedRim& rim_;
};

// Undoes the vertical steps. Each runs as soon as its rows are ready, while they are still in the cache.
class VerticalSynthesis {
  public:
    VerticalSynthesis(const RowLifting& lifting, Number* image, uint32_t columns, uint32_t rows, const SharedRim& rim)
        : lifting_(lifting),
          image_(image),
          rim_(rim),
          width_(3 * size_t{columns}),
          lows_(low_count(rows)),
          highs_(high_count(rows)),
          lifted_(lifted_lows(low_count(rows), static_cast<bool>(rim))) {}

    // Goes on, now that rows up to 2i+1 (i < highs) or all rows (i == highs) are there.
    void advance(ptrdiff_t i) {
        step(0, i);
        if (i == highs_) {
            for (int k = 1; k < lifting_.pairs(); ++k) step(k, highs_);
        }
    }

  private:
    // Runs pair k of steps on low row i. Pair k runs k rows behind pair 0.
    void step(int k, ptrdiff_t i) {
        if (i < 0) return;
        const int s = lifting_.low_step(k);
        if (i > 0 && i < highs_ && is_lifted(i)) {
            lift_low_and_high(s, i);
        } else {
            if (i < lows_) lift_low(s, i);
            if (i > 0) lift_high(s - 1, i - 1);
        }
        if (k + 1 < lifting_.pairs()) step(k + 1, i - 1);
    }
    // Lifts low row i and high row i-1 at once; all the rows differ.
    void lift_low_and_high(int s, ptrdiff_t i) {
        Number *target = low(i), *high_target = high(i - 1);
        const Number *before = low(i - 1), *behind = high(i);
        const auto [begin, end] = lifted_part(rim_, static_cast<uint32_t>(2 * i), width_);
        lifting_.undo_pair(s, target + begin, high_target + begin, behind + begin, before + begin, end - begin);
        const auto lift_kept = [&](size_t from, size_t count) {
            lifting_.undo_end(s, target + from, count);
            lifting_.undo(s - 1, high_target + from, before + from, target + from, count);
        };
        if (begin > 0) lift_kept(0, begin);
        if (end < width_) lift_kept(end, width_ - end);
    }
    bool is_lifted(ptrdiff_t i) const {
        return i >= static_cast<ptrdiff_t>(lifted_.begin) && i < static_cast<ptrdiff_t>(lifted_.end);
    }
    Number* low(ptrdiff_t i) { return image_ + static_cast<size_t>(2 * std::min(i, lows_ - 1)) * width_; }
    Number* high(ptrdiff_t i) {
        return image_ + static_cast<size_t>(2 * std::clamp<ptrdiff_t>(i, 0, highs_ - 1) + 1) * width_;
    }
    void lift_low(int s, ptrdiff_t i) {
        const auto [begin, end] =
            is_lifted(i) ? lifted_part(rim_, static_cast<uint32_t>(2 * i), width_) : LiftedRange{0, 0};
        lifting_.undo(s, low(i) + begin, high(i - 1) + begin, high(i) + begin, end - begin);
        lifting_.undo_end(s, low(i), begin);
        lifting_.undo_end(s, low(i) + end, width_ - end);
    }
    void lift_high(int s, ptrdiff_t i) { lifting_.undo(s, high(i), low(i), low(i + 1), width_); }

    const RowLifting& lifting_;
    Number* image_;
    const SharedRim& rim_;
    size_t width_;
    ptrdiff_t lows_, highs_;
    LiftedRange lifted_;
};

}  // namespace

void synthesize(const RowLifting& lifting, uint32_t columns, uint32_t rows, const Number* low, const LevelBands& bands,
                const DetailSteps& steps, Number* work, Number* image, const SharedRim& rim) {
    const size_t lows = low_count(columns), highs = high_count(columns), width = size_t{columns} * 3;
    Number* low_row = work;
    Number* high_row = work + 3 * (lows + 1) + 3;
    const HorizontalSynthesis horizontal(lifting, rows, rim);
    VerticalSynthesis vertical(lifting, image, columns, rows, rim);
    DetailRows details(lifting.integers(), low, low_count(columns), low_count(rows), bands, steps, rim);
    for (uint32_t i = 0; i <= rows / 2; ++i) {
        if (2 * i < rows) {
            lifting.load_low(low + i * 3 * lows, 3 * lows, low_row);
            const bool any = details.load(Orientation::kHorizontal, i, high_row);
            horizontal.write({lows, highs, low_row, high_row, any}, 2 * i, image + 2 * i * width);
        }
        if (2 * i + 1 < rows) {
            const bool any_low = details.load(Orientation::kVertical, i, low_row);
            const bool any_high = details.load(Orientation::kDiagonal, i, high_row);
            Number* row = image + (2 * i + 1) * width;
            if (any_low || any_high)
                horizontal.write({lows, highs, low_row, high_row, any_high}, 2 * i + 1, row);
            else
                std::fill_n(row, width, Number{0});  // what lifting makes of zeros
        }
        vertical.advance(static_cast<ptrdiff_t>(i));
    }
}

}  // namespace gim

#include "encoder/code/wavelet_analysis.h"

#include <algorithm>

namespace gim {
namespace {

// Applies an odd lifting step to columns. low(i), high(i): rows of `width` values. high(highs) is the last high row.
template <class Wavelet, Direction D, class Low, class High>
void lift_low_rows(int step, size_t lows, size_t width, const Low& low, const High& high, const SharedRim& rim) {
    const auto [begin, end] = lifted_lows(lows, static_cast<bool>(rim));
    if (begin > 0) lift_end<Wavelet, D>(step, low(0), width);
    for (size_t i = begin; i < end; ++i)
        lift_low_row<Wavelet, D>(step, low(i), high(i == 0 ? 0 : i - 1), high(i), width, rim,
                                 static_cast<uint32_t>(2 * i));
    if (end < lows) lift_end<Wavelet, D>(step, low(end), width);
}

// Applies the forward steps to every column. Whole rows are the operands.
template <class Wavelet>
void analyse_columns(typename Wavelet::Sample* image, uint32_t columns, uint32_t rows, const SharedRim& rim) {
    const size_t width = size_t{columns} * 3, lows = low_count(rows), highs = high_count(rows);
    const auto low = [&](size_t i) { return image + 2 * std::min(i, lows - 1) * width; };
    const auto high = [&](size_t i) { return image + (2 * std::min(i, highs - 1) + 1) * width; };
    for (int step = 0; step < Wavelet::kSteps; step += 2) {
        for (size_t i = 0; i < highs; ++i)
            lift_row<Wavelet, Direction::kAnalysis>(step, high(i), low(i), low(i + 1), width);
        lift_low_rows<Wavelet, Direction::kAnalysis>(step + 1, lows, width, low, high, rim);
    }
}

// Splits a row into low and high triples. Both have room for one more triple at the end, high also at the front.
template <class Wavelet, class Keeps>
void analyse_row(const typename Wavelet::Sample* row, size_t lows, size_t highs, typename Wavelet::Sample* low,
                 typename Wavelet::Sample* high, const Keeps& keeps) {
    for (size_t i = 0; i < lows; ++i) std::copy_n(row + 6 * i, 3, low + 3 * i);
    for (size_t i = 0; i < highs; ++i) std::copy_n(row + 6 * i + 3, 3, high + 3 * i);
    for (int step = 0; step < Wavelet::kSteps; step += 2) {
        std::copy_n(low + 3 * (lows - 1), 3, low + 3 * lows);
        lift_row<Wavelet, Direction::kAnalysis>(step, high, low, low + 3, 3 * highs);
        lift_lows<Wavelet, Direction::kAnalysis>(step + 1, lows, highs, low, high, keeps);
    }
}

// The next two undo analyse_columns and analyse_row.
template <class Wavelet>
void restore_columns(typename Wavelet::Sample* image, uint32_t columns, uint32_t rows, const SharedRim& rim) {
    const size_t width = size_t{columns} * 3, lows = low_count(rows), highs = high_count(rows);
    const auto low = [&](size_t i) { return image + 2 * std::min(i, lows - 1) * width; };
    const auto high = [&](size_t i) { return image + (2 * std::min(i, highs - 1) + 1) * width; };
    for (int step = Wavelet::kSteps - 2; step >= 0; step -= 2) {
        lift_low_rows<Wavelet, Direction::kSynthesis>(step + 1, lows, width, low, high, rim);
        for (size_t i = 0; i < highs; ++i)
            lift_row<Wavelet, Direction::kSynthesis>(step, high(i), low(i), low(i + 1), width);
    }
}

template <class Wavelet, class Keeps>
void restore_row(typename Wavelet::Sample* low, typename Wavelet::Sample* high, size_t lows, size_t highs,
                 typename Wavelet::Sample* row, const Keeps& keeps) {
    for (int step = Wavelet::kSteps - 2; step >= 0; step -= 2) {
        lift_lows<Wavelet, Direction::kSynthesis>(step + 1, lows, highs, low, high, keeps);
        std::copy_n(low + 3 * (lows - 1), 3, low + 3 * lows);
        lift_row<Wavelet, Direction::kSynthesis>(step, high, low, low + 3, 3 * highs);
    }
    for (size_t i = 0; i < lows; ++i) std::copy_n(low + 3 * i, 3, row + 6 * i);
    for (size_t i = 0; i < highs; ++i) std::copy_n(high + 3 * i, 3, row + 6 * i + 3);
}

void from_unit_gain(int32_t*, size_t) {}
void from_unit_gain(float* low, size_t count) {
    for (size_t i = 0; i < count; ++i) low[i] = low[i] * Irreversible97::kLowGain;
}
void to_unit_gain(int32_t*, size_t) {}
void to_unit_gain(float* low, size_t count) {
    for (size_t i = 0; i < count; ++i) low[i] = low[i] / Irreversible97::kLowGain;
}

}  // namespace

Pyramid<float> zero_pyramid(uint32_t columns, uint32_t rows, uint32_t steps) {
    Pyramid<float> pyramid{columns, rows, {}, std::vector<AnalysisLevel<float>>(steps)};
    pyramid.base.resize(size_t{3} * pyramid.columns_at(0) * pyramid.rows_at(0));
    for (uint32_t e = 1; e <= steps; ++e) {
        const uint32_t c = pyramid.columns_at(e), r = pyramid.rows_at(e);
        AnalysisLevel<float>& level = pyramid.levels[e - 1];
        level.horizontal.resize(size_t{3} * low_count(r) * high_count(c));
        level.vertical.resize(size_t{3} * high_count(r) * low_count(c));
        level.diagonal.resize(size_t{3} * high_count(r) * high_count(c));
    }
    return pyramid;
}

template <class Wavelet>
Pyramid<typename Wavelet::Sample> analyse(std::vector<typename Wavelet::Sample> image, uint32_t columns, uint32_t rows,
                                          uint32_t steps, const SeamTable* seams) {
    using Sample = typename Wavelet::Sample;
    Pyramid<Sample> pyramid;
    pyramid.columns = columns;
    pyramid.rows = rows;
    pyramid.levels.resize(steps);
    for (size_t e = steps; e > 0; --e) {
        const size_t lows = low_count(columns), highs = high_count(columns);
        AnalysisLevel<Sample>& level = pyramid.levels[e - 1];
        level.horizontal.resize(low_count(rows) * highs * 3);
        level.vertical.resize(high_count(rows) * lows * 3);
        level.diagonal.resize(high_count(rows) * highs * 3);
        std::vector<Sample> low_image(low_count(rows) * lows * 3), low((lows + 1) * 3), high((highs + 2) * 3);

        const OwnSharedRim own_rim(seams, columns);
        const SharedRim rim = own_rim.view();
        analyse_columns<Wavelet>(image.data(), columns, rows, rim);
        for (size_t r = 0; r < rows; ++r) {
            analyse_row<Wavelet>(image.data() + r * columns * 3, lows, highs, low.data(), high.data() + 3,
                                 KeepsOfRow{rim, static_cast<uint32_t>(r), rows});
            auto& to_low = r % 2 == 0 ? low_image : level.vertical;
            auto& to_high = r % 2 == 0 ? level.horizontal : level.diagonal;
            if (r % 2 == 0) to_unit_gain(low.data(), lows * 3);
            std::copy_n(low.begin(), lows * 3, to_low.begin() + static_cast<ptrdiff_t>((r / 2) * lows * 3));
            std::copy_n(high.begin() + 3, highs * 3, to_high.begin() + static_cast<ptrdiff_t>((r / 2) * highs * 3));
        }
        image = std::move(low_image);
        columns = low_count(columns);
        rows = low_count(rows);
    }
    pyramid.base = std::move(image);
    return pyramid;
}

template <class Wavelet>
std::vector<typename Wavelet::Sample> restore(const Pyramid<typename Wavelet::Sample>& pyramid,
                                              const SeamTable* seams) {
    using Sample = typename Wavelet::Sample;
    std::vector<Sample> image = pyramid.base;
    for (uint32_t step = 1; step <= pyramid.steps(); ++step) {
        const uint32_t columns = pyramid.columns_at(step), rows = pyramid.rows_at(step);
        const size_t lows = low_count(columns), highs = high_count(columns);
        const AnalysisLevel<Sample>& level = pyramid.levels[step - 1];
        const OwnSharedRim own_rim(seams, columns);
        const SharedRim rim = own_rim.view();
        std::vector<Sample> next(size_t{columns} * rows * 3), low((lows + 1) * 3), high((highs + 2) * 3);
        for (size_t r = 0; r < rows; ++r) {
            const auto& from_low = r % 2 == 0 ? image : level.vertical;
            const auto& from_high = r % 2 == 0 ? level.horizontal : level.diagonal;
            std::copy_n(from_low.begin() + static_cast<ptrdiff_t>((r / 2) * lows * 3), lows * 3, low.begin());
            std::copy_n(from_high.begin() + static_cast<ptrdiff_t>((r / 2) * highs * 3), highs * 3, high.begin() + 3);
            if (r % 2 == 0) from_unit_gain(low.data(), lows * 3);
            restore_row<Wavelet>(low.data(), high.data() + 3, lows, highs, next.data() + r * columns * 3,
                                 KeepsOfRow{rim, static_cast<uint32_t>(r), rows});
        }
        restore_columns<Wavelet>(next.data(), columns, rows, rim);
        image = std::move(next);
    }
    return image;
}

namespace {

// Subtracts factor * source[i] from target[i]: the transpose of half a lifting step.
void take_off(float factor, float* __restrict target, const float* __restrict source, size_t count) {
    for (size_t i = 0; i < count; ++i) target[i] -= factor * source[i];
}

// Transposes the lifting steps of restore_row or restore_columns: the order is reversed, and operands that were read
// are written. low(i), high(i): operands of `width` floats. span(i): the part of low(i) that is lifted.
template <class Low, class High, class Span>
void transpose_steps(size_t lows, size_t highs, const Low& low, const High& high, size_t width, bool keeps_ends,
                     const Span& span) {
    const LiftedRange lifted = lifted_lows(lows, keeps_ends);
    for (size_t step = 0; step < 4; step += 2) {
        for (size_t i = 0; i < highs; ++i) {
            take_off(Irreversible97::kFactor[step], low(i), high(i), width);
            take_off(Irreversible97::kFactor[step], low(std::min(i + 1, lows - 1)), high(i), width);
        }
        for (size_t i = 0; i < lows; ++i) {
            const bool is_end = i < lifted.begin || i >= lifted.end;
            const auto [begin, end] = is_end ? LiftedRange{0, 0} : span(i);
            lift_end<Irreversible97, Direction::kSynthesis>(static_cast<int>(step) + 1, low(i), begin);
            lift_end<Irreversible97, Direction::kSynthesis>(static_cast<int>(step) + 1, low(i) + end, width - end);
            if (begin == end) continue;
            take_off(Irreversible97::kFactor[step + 1], high(i == 0 ? 0 : i - 1) + begin, low(i) + begin, end - begin);
            take_off(Irreversible97::kFactor[step + 1], high(std::min(i, highs - 1)) + begin, low(i) + begin,
                     end - begin);
        }
    }
}

}  // namespace

Pyramid<float> restore_transposed(std::vector<float> image, uint32_t columns, uint32_t rows, uint32_t steps,
                                  const SeamTable* seams) {
    Pyramid<float> pyramid;
    pyramid.columns = columns;
    pyramid.rows = rows;
    pyramid.levels.resize(steps);
    for (size_t e = steps; e > 0; --e) {
        const size_t lows = low_count(columns), highs = high_count(columns), width = size_t{columns} * 3;
        AnalysisLevel<float>& level = pyramid.levels[e - 1];
        level.horizontal.resize(low_count(rows) * highs * 3);
        level.vertical.resize(high_count(rows) * lows * 3);
        level.diagonal.resize(high_count(rows) * highs * 3);
        std::vector<float> low_image(low_count(rows) * lows * 3);
        const OwnSharedRim own_rim(seams, columns);
        const SharedRim rim = own_rim.view();
        transpose_steps(
            low_count(rows), high_count(rows), [&](size_t i) { return image.data() + 2 * i * width; },
            [&](size_t i) { return image.data() + (2 * i + 1) * width; }, width, static_cast<bool>(rim),
            [&](size_t i) { return lifted_part(rim, static_cast<uint32_t>(2 * i), width); });
        for (size_t r = 0; r < rows; ++r) {
            float* row = image.data() + r * width;
            const KeepsOfRow keeps{rim, static_cast<uint32_t>(r), rows};
            transpose_steps(
                lows, highs, [&](size_t i) { return row + 6 * i; }, [&](size_t i) { return row + 6 * i + 3; }, 3,
                keeps.ends(),
                [&](size_t i) {
                    return keeps(i) ? LiftedRange{0, 0} : LiftedRange{0, 3};
                });
            float* to_low = (r % 2 == 0 ? low_image : level.vertical).data() + (r / 2) * lows * 3;
            float* to_high = (r % 2 == 0 ? level.horizontal : level.diagonal).data() + (r / 2) * highs * 3;
            for (size_t i = 0; i < lows; ++i) std::copy_n(row + 6 * i, 3, to_low + 3 * i);
            for (size_t i = 0; i < highs; ++i) std::copy_n(row + 6 * i + 3, 3, to_high + 3 * i);
            if (r % 2 == 0) from_unit_gain(to_low, lows * 3);
        }
        image = std::move(low_image);
        columns = low_count(columns);
        rows = low_count(rows);
    }
    pyramid.base = std::move(image);
    return pyramid;
}

template std::vector<int32_t> restore<Reversible53>(const Pyramid<int32_t>&, const SeamTable*);
template std::vector<float> restore<Irreversible97>(const Pyramid<float>&, const SeamTable*);
template Pyramid<int32_t> analyse<Reversible53>(std::vector<int32_t>, uint32_t, uint32_t, uint32_t, const SeamTable*);
template Pyramid<float> analyse<Irreversible97>(std::vector<float>, uint32_t, uint32_t, uint32_t, const SeamTable*);

}  // namespace gim

#include "encoder/wavelet_analysis.h"

#include <algorithm>
#include <bit>

namespace gim {
namespace {

// Forward steps on every column: rows are the operands.
template <class Wavelet>
void analyse_columns(typename Wavelet::Sample* image, size_t side) {
    const size_t width = side * 3, h = side / 2;
    const auto low = [&](size_t i) { return image + 2 * i * width; };
    const auto high = [&](size_t i) { return image + (2 * i + 1) * width; };
    for (int step = 0; step < Wavelet::kSteps; step += 2) {
        for (size_t i = 0; i < h; ++i)
            lift_row<Wavelet, Direction::kAnalysis>(step, high(i), low(i), low(i + 1), width);
        for (size_t i = 0; i <= h; ++i)
            lift_row<Wavelet, Direction::kAnalysis>(step + 1, low(i), high(i == 0 ? 0 : i - 1),
                                                    high(std::min(i, h - 1)), width);
    }
}

// Splits a row of 2h+1 triples into h+1 low and h high ones; high has room for a triple on either side.
template <class Wavelet>
void analyse_row(const typename Wavelet::Sample* row, size_t h, typename Wavelet::Sample* low,
                 typename Wavelet::Sample* high) {
    for (size_t i = 0; i <= h; ++i) std::copy_n(row + 6 * i, 3, low + 3 * i);
    for (size_t i = 0; i < h; ++i) std::copy_n(row + 6 * i + 3, 3, high + 3 * i);
    for (int step = 0; step < Wavelet::kSteps; step += 2) {
        lift_row<Wavelet, Direction::kAnalysis>(step, high, low, low + 3, 3 * h);
        std::copy_n(high, 3, high - 3);
        std::copy_n(high + 3 * (h - 1), 3, high + 3 * h);
        lift_row<Wavelet, Direction::kAnalysis>(step + 1, low, high - 3, high, 3 * (h + 1));
    }
}

void to_unit_gain(int32_t*, size_t) {}
void to_unit_gain(float* low, size_t count) {
    for (size_t i = 0; i < count; ++i) low[i] = low[i] / Irreversible97::kLowGain;
}

}  // namespace

template <class Wavelet>
Pyramid<typename Wavelet::Sample> analyse(std::vector<typename Wavelet::Sample> image, uint32_t side) {
    using Sample = typename Wavelet::Sample;
    Pyramid<Sample> pyramid;
    pyramid.side = side;
    pyramid.levels.resize(static_cast<size_t>(std::countr_zero(side - 1)));
    for (size_t e = pyramid.levels.size(); e > 0; --e) {
        const size_t h = size_t{1} << (e - 1), n = 2 * h + 1;
        AnalysisLevel<Sample>& level = pyramid.levels[e - 1];
        level.horizontal.resize((h + 1) * h * 3);
        level.vertical.resize(h * (h + 1) * 3);
        level.diagonal.resize(h * h * 3);
        std::vector<Sample> low_image((h + 1) * (h + 1) * 3), low((h + 1) * 3), high((h + 2) * 3);

        analyse_columns<Wavelet>(image.data(), n);
        for (size_t r = 0; r < n; ++r) {
            analyse_row<Wavelet>(image.data() + r * n * 3, h, low.data(), high.data() + 3);
            auto& to_low = r % 2 == 0 ? low_image : level.vertical;
            auto& to_high = r % 2 == 0 ? level.horizontal : level.diagonal;
            if (r % 2 == 0) to_unit_gain(low.data(), low.size());
            std::copy(low.begin(), low.end(), to_low.begin() + static_cast<ptrdiff_t>((r / 2) * (h + 1) * 3));
            std::copy_n(high.begin() + 3, h * 3, to_high.begin() + static_cast<ptrdiff_t>((r / 2) * h * 3));
        }
        image = std::move(low_image);
    }
    pyramid.base = std::move(image);
    return pyramid;
}

template Pyramid<int32_t> analyse<Reversible53>(std::vector<int32_t>, uint32_t);
template Pyramid<float> analyse<Irreversible97>(std::vector<float>, uint32_t);

}  // namespace gim

#include "encoder/code/extend_chart.h"

#include <algorithm>
#include <cmath>

namespace gim {

namespace {

// Fills undefined samples. Halves the grid in both directions, with the mean of the defined samples, until no sample is
// undefined. Then copies values back to the undefined samples of each finer grid.
void pull_push(std::vector<float>& values, std::vector<float> weights, uint32_t columns, uint32_t rows) {
    if (std::all_of(weights.begin(), weights.end(), [](float w) { return w > 0; }) || (columns == 1 && rows == 1))
        return;
    const uint32_t half_columns = low_count(columns), half_rows = low_count(rows);
    std::vector<float> half(size_t{half_columns} * half_rows * 3, 0.0f), half_weights(half.size() / 3, 0.0f);
    for (uint32_t row = 0; row < rows; ++row) {
        for (uint32_t column = 0; column < columns; ++column) {
            const size_t from = size_t{row} * columns + column, to = size_t{row / 2} * half_columns + column / 2;
            half_weights[to] += weights[from];
            for (size_t k = 0; k < 3; ++k) half[to * 3 + k] += weights[from] * values[from * 3 + k];
        }
    }
    for (size_t i = 0; i < half_weights.size(); ++i) {
        if (!(half_weights[i] > 0)) continue;
        for (size_t k = 0; k < 3; ++k) half[i * 3 + k] /= half_weights[i];
        half_weights[i] = 1;
    }
    pull_push(half, half_weights, half_columns, half_rows);
    for (uint32_t row = 0; row < rows; ++row) {
        for (uint32_t column = 0; column < columns; ++column) {
            const size_t to = size_t{row} * columns + column, from = size_t{row / 2} * half_columns + column / 2;
            if (weights[to] > 0) continue;
            for (size_t k = 0; k < 3; ++k) values[to * 3 + k] = half[from * 3 + k];
        }
    }
}

template <class Sample>
Sample to_sample(float v) {
    if constexpr (std::is_integral_v<Sample>) return static_cast<Sample>(std::lround(v));
    return static_cast<Sample>(v);
}

template <class Sample>
void drop_small(Pyramid<Sample>& pyramid, double threshold) {
    for (uint32_t e = 0; e < pyramid.steps(); ++e) {
        const uint32_t depth = pyramid.steps() - e;
        // Gives about equal errors in the image. Uses the norms of lifting.h; those of the 5/3 wavelet are similar.
        const auto shrink = [&](std::vector<Sample>& band, Orientation orientation) {
            const auto most = static_cast<Sample>(band_step(static_cast<float>(threshold), depth, orientation));
            for (Sample& v : band) {
                if (std::abs(v) < most) v = 0;
            }
        };
        shrink(pyramid.levels[e].horizontal, Orientation::kHorizontal);
        shrink(pyramid.levels[e].vertical, Orientation::kVertical);
        shrink(pyramid.levels[e].diagonal, Orientation::kDiagonal);
    }
}

// One projection: drops details below the threshold, then puts the defined samples back.
template <class Wavelet>
void project(std::vector<typename Wavelet::Sample>& image, const std::vector<uint8_t>& defined, uint32_t columns,
             uint32_t rows, uint32_t steps, double threshold) {
    auto pyramid = analyse<Wavelet>(image, columns, rows, steps);
    drop_small(pyramid, threshold);
    const auto smooth = restore<Wavelet>(pyramid);
    for (size_t i = 0; i < image.size(); ++i) {
        if (!defined[i / 3]) image[i] = smooth[i];
    }
}

}  // namespace

template <class Wavelet>
std::vector<typename Wavelet::Sample> extend_chart(std::vector<typename Wavelet::Sample> values,
                                                   const std::vector<uint8_t>& defined, uint32_t columns, uint32_t rows,
                                                   uint32_t steps, float finest, int rounds) {
    using Sample = typename Wavelet::Sample;
    std::vector<float> filled(values.begin(), values.end());
    pull_push(filled, std::vector<float>(defined.begin(), defined.end()), columns, rows);
    float low = filled[0], high = filled[0];
    std::vector<Sample> image(values.size());
    for (size_t i = 0; i < image.size(); ++i) {
        image[i] = defined[i / 3] ? values[i] : to_sample<Sample>(filled[i]);
        low = std::min(low, filled[i]);
        high = std::max(high, filled[i]);
    }
    const double first = std::max<double>(0.25 * (high - low), 2 * finest);
    for (int round = 0; round < rounds; ++round) {
        const double threshold = first * std::pow(finest / first, double(round) / std::max(rounds - 1, 1));
        project<Wavelet>(image, defined, columns, rows, steps, threshold);
    }
    return image;
}

std::vector<float> extend_again(std::vector<float> image, const std::vector<uint8_t>& defined, uint32_t columns,
                                uint32_t rows, uint32_t steps, float finest, int rounds) {
    for (int round = 0; round < rounds; ++round) project<Irreversible97>(image, defined, columns, rows, steps, finest);
    return image;
}

template std::vector<int32_t> extend_chart<Reversible53>(std::vector<int32_t>, const std::vector<uint8_t>&, uint32_t,
                                                         uint32_t, uint32_t, float, int);
template std::vector<float> extend_chart<Irreversible97>(std::vector<float>, const std::vector<uint8_t>&, uint32_t,
                                                         uint32_t, uint32_t, float, int);

}  // namespace gim

#include "decoder/synthesis.h"

#include <algorithm>

namespace gim {
namespace {

template <class Wavelet>
constexpr int low_step(
    int i) {  // synthesis undoes the steps from the last to the first; the last one changed the low samples
    return Wavelet::kSteps - 1 - 2 * i;
}

void load_high(const int32_t* band, size_t count, float, int32_t* row) { std::copy_n(band, count, row); }
void load_high(const int32_t* band, size_t count, float step, float* row) {
    for (size_t i = 0; i < count; ++i) row[i] = dequantize(band[i], step);
}
void load_low(const int32_t* low, size_t count, int32_t* row) { std::copy_n(low, count, row); }
void load_low(const float* low, size_t count, float* row) {
    for (size_t i = 0; i < count; ++i) row[i] = low[i] * Irreversible97::kLowGain;
}

// Undoes the horizontal steps on one row given as low triples 0..h and high triples 0..h-1; high has room for a triple
// on either side. Writes 2h+1 triples.
template <class Wavelet>
void synthesize_row(size_t h, typename Wavelet::Sample* low, typename Wavelet::Sample* high,
                    typename Wavelet::Sample* row) {
    for (int i = 0; i < Wavelet::kSteps / 2; ++i) {
        std::copy_n(high, 3, high - 3);
        std::copy_n(high + 3 * (h - 1), 3, high + 3 * h);
        lift_row<Wavelet, Direction::kSynthesis>(low_step<Wavelet>(i), low, high - 3, high, 3 * (h + 1));
        lift_row<Wavelet, Direction::kSynthesis>(low_step<Wavelet>(i) - 1, high, low, low + 3, 3 * h);
    }
    for (size_t i = 0; i < h; ++i) {
        for (size_t k = 0; k < 3; ++k) row[6 * i + k] = low[3 * i + k];
        for (size_t k = 0; k < 3; ++k) row[6 * i + 3 + k] = high[3 * i + k];
    }
    std::copy_n(low + 3 * h, 3, row + 6 * h);
}

// Vertical steps, each as early as its rows are ready so that they are still in the cache.
template <class Wavelet>
class VerticalSynthesis {
  public:
    using Sample = typename Wavelet::Sample;

    VerticalSynthesis(Sample* image, size_t side)
        : image_(image), width_(3 * side), h_(static_cast<ptrdiff_t>(side / 2)) {}

    // Rows up to 2i+1 (i < h) or all rows (i == h) are there.
    void advance(ptrdiff_t i) {
        step(0, i);
        if (i == h_) {
            for (int k = 1; k < Wavelet::kSteps / 2; ++k) step(k, h_);
        }
    }

  private:
    // Pair k of steps, ready for low row i of its first step: pair k runs k rows behind pair 0.
    void step(int k, ptrdiff_t i) {
        if (i < 0) return;
        lift_low(low_step<Wavelet>(k), i);
        if (i > 0) lift_high(low_step<Wavelet>(k) - 1, i - 1);
        if (k + 1 < Wavelet::kSteps / 2) step(k + 1, i - 1);
    }
    Sample* low(ptrdiff_t i) { return image_ + static_cast<size_t>(2 * i) * width_; }
    Sample* high(ptrdiff_t i) {
        return image_ + static_cast<size_t>(2 * std::clamp<ptrdiff_t>(i, 0, h_ - 1) + 1) * width_;
    }
    void lift_low(int s, ptrdiff_t i) {
        lift_row<Wavelet, Direction::kSynthesis>(s, low(i), high(i - 1), high(i), width_);
    }
    void lift_high(int s, ptrdiff_t i) {
        lift_row<Wavelet, Direction::kSynthesis>(s, high(i), low(i), low(i + 1), width_);
    }

    Sample* image_;
    size_t width_;
    ptrdiff_t h_;
};

}  // namespace

template <class Wavelet>
void synthesize(uint32_t side, const typename Wavelet::Sample* low, const LevelBands& bands, const BandSteps& steps,
                typename Wavelet::Sample* work, typename Wavelet::Sample* image) {
    const size_t h = side / 2;
    const size_t width = size_t{side} * 3;
    auto* low_row = work;
    auto* high_row = work + 3 * (h + 1) + 3;
    VerticalSynthesis<Wavelet> vertical(image, side);
    for (size_t i = 0; i <= h; ++i) {
        load_low(low + i * 3 * (h + 1), 3 * (h + 1), low_row);
        load_high(bands.horizontal.row(static_cast<uint32_t>(i)), 3 * h, steps.edge, high_row);
        synthesize_row<Wavelet>(h, low_row, high_row, image + 2 * i * width);
        if (i < h) {
            load_high(bands.vertical.row(static_cast<uint32_t>(i)), 3 * (h + 1), steps.edge, low_row);
            load_high(bands.diagonal.row(static_cast<uint32_t>(i)), 3 * h, steps.diagonal, high_row);
            synthesize_row<Wavelet>(h, low_row, high_row, image + (2 * i + 1) * width);
        }
        vertical.advance(static_cast<ptrdiff_t>(i));
    }
}

template void synthesize<Reversible53>(uint32_t, const int32_t*, const LevelBands&, const BandSteps&, int32_t*,
                                       int32_t*);
template void synthesize<Irreversible97>(uint32_t, const float*, const LevelBands&, const BandSteps&, float*, float*);

}  // namespace gim

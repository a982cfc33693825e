#include "encoder/tiles/transpose_tiles.h"

#include <algorithm>
#include <utility>

#include "format/tile_lifting.h"

namespace gim {
namespace {

// One step. The planes hold one value per copy of a shared sample. Only the sum over the copies has a meaning. A step of
// synthesis x = x - f * (a + b) turns into a = a - f * x, b = b - f * x, in the opposite order.
template <class Wavelet>
class Transpose {
  public:
    Transpose(const QuadComplex& complex, const TilePlanes& planes, float* samples)
        : complex_(complex), planes_(planes), samples_(samples), sums_(3 * size_t{complex.vertices}) {}

    void run() {
        for (int step = 0; step < Wavelet::kSteps; step += 2) {
            factor_ = Wavelet::kFactor[static_cast<size_t>(step)];
            for (uint32_t t = 0; t < complex_.tiles; ++t) predict(tile(t));
            factor_ = Wavelet::kFactor[static_cast<size_t>(step) + 1];
            vertices();
            for (uint32_t e = 0; e < complex_.edges; ++e) edge(complex_.lower[e]);
            for (uint32_t t = 0; t < complex_.tiles; ++t) update_inside(tile(t));
        }
        for (uint32_t e = 0; e < complex_.edges; ++e) gather(complex_.lower[e]);
        for (uint32_t t = 0; t < complex_.tiles; ++t) {
            for (ptrdiff_t i = 0; i < planes_.horizontal(); ++i) tile(t)[i] *= Wavelet::kLowGain;
        }
    }

  private:
    float* tile(uint32_t t) const { return samples_ + t * planes_.size(); }

    void take_off(const float* x, float* a, size_t count, float factor) const {
        for (size_t i = 0; i < count; ++i) a[i] -= factor * x[i];
    }
    void take_off(const float* x, float* a, float* b, size_t count) const {
        take_off(x, a, count, factor_);
        take_off(x, b, count, factor_);
    }

    void predict(float* low) const {
        const uint32_t h = planes_.h;
        const size_t row = 3 * size_t{h}, low_row = row + 3;
        float *horizontal = low + planes_.horizontal(), *vertical = low + planes_.vertical(),
              *diagonal = low + planes_.diagonal();
        for (uint32_t r = 0; r < h; ++r)
            take_off(diagonal + r * row, horizontal + r * row, horizontal + (r + 1) * row, row);
        for (uint32_t r = 0; r < h; ++r)
            take_off(vertical + r * low_row, low + r * low_row, low + (r + 1) * low_row, low_row);
        for (uint32_t r = 0; r <= h; ++r) take_off(horizontal + r * row, low + r * low_row, low + r * low_row + 3, row);
        for (uint32_t r = 0; r < h; ++r)
            take_off(diagonal + r * row, vertical + r * low_row, vertical + r * low_row + 3, row);
    }

    void update_inside(float* low) const {
        const uint32_t h = planes_.h;
        const size_t row = 3 * size_t{h}, low_row = row + 3, inside = row - 3;
        float *horizontal = low + planes_.horizontal(), *vertical = low + planes_.vertical(),
              *diagonal = low + planes_.diagonal();
        for (uint32_t r = 1; r < h; ++r)
            take_off(low + r * low_row + 3, vertical + (r - 1) * low_row + 3, vertical + r * low_row + 3, inside);
        for (uint32_t r = 1; r < h; ++r)
            take_off(horizontal + r * row, diagonal + (r - 1) * row, diagonal + r * row, row);
        for (uint32_t r = 1; r < h; ++r)
            take_off(low + r * low_row + 3, horizontal + r * row, horizontal + r * row + 3, inside);
        for (uint32_t r = 0; r < h; ++r)
            take_off(vertical + r * low_row + 3, diagonal + r * row, diagonal + r * row + 3, inside);
    }

    void vertices() {
        std::fill(sums_.begin(), sums_.end(), 0.0f);
        for (uint32_t h = 0; h < complex_.half_edges(); ++h) {
            const float* low = tile(tile_of(h)) + planes_.sides[side_of(h)].low.at(0);
            for (size_t k = 0; k < 3; ++k) sums_[3 * size_t{complex_.vertex[h]} + k] += low[k];
        }
        for (uint32_t h = 0; h < complex_.half_edges(); ++h) {
            const uint32_t v = complex_.vertex[h], before = previous_side(h);
            const TileSide& side = planes_.sides[side_of(h)];
            const bool mirrored = complex_.on_boundary[v];
            const float weight = 4.0f / static_cast<float>(complex_.valence[v] * (mirrored ? 2 : 1));
            const float* sum = &sums_[3 * size_t{v}];
            float* own = tile(tile_of(h));
            take_off(sum, own + side.high.at(0), 3,
                     factor_ * weight * (mirrored && complex_.mate[h] != kNoMate ? 2.0f : 1.0f));
            if (complex_.mate[before] == kNoMate)
                take_off(sum, own + planes_.sides[side_of(before)].high.at(planes_.h - 1), 3, factor_ * weight);
            take_off(sum, own + side.faces.at(0), 3, factor_ * factor_ * weight * (mirrored ? 2.0f : 1.0f));
        }
    }

    void edge(uint32_t half_edge) const {
        const uint32_t h = planes_.h, mate = complex_.mate[half_edge];
        const bool has_mate = mate != kNoMate;
        const uint32_t other = has_mate ? mate : half_edge;
        const TileSide &side = planes_.sides[side_of(half_edge)], &mate_side = planes_.sides[side_of(other)];
        float *own = tile(tile_of(half_edge)), *shared = tile(tile_of(other));
        const auto sum_of = [&](const float* a, const float* b, float* sum) {
            for (size_t k = 0; k < 3; ++k) sum[k] = has_mate ? a[k] + b[k] : a[k];
        };
        float sum[3];
        for (uint32_t i = 1; i < h; ++i) {
            sum_of(own + side.low.at(i), shared + mate_side.low.at(h - i), sum);
            take_off(sum, own + side.across.at(i), shared + mate_side.across.at(has_mate ? h - i : i), 3);
        }
        for (uint32_t i = 0; i < h; ++i) {
            const uint32_t back = h - 1 - i;
            sum_of(own + side.high.at(i), shared + mate_side.high.at(back), sum);
            take_off(sum, own + side.faces.at(i), shared + mate_side.faces.at(has_mate ? back : i), 3);
        }
        for (uint32_t i = 1; i < h; ++i) {
            sum_of(own + side.low.at(i), shared + mate_side.low.at(h - i), sum);
            take_off(sum, own + side.high.at(i - 1), own + side.high.at(i), 3);
        }
    }

    void gather(uint32_t half_edge) const {
        const uint32_t mate = complex_.mate[half_edge];
        if (mate == kNoMate) return;
        for (uint32_t i = 0; i < planes_.h; ++i) {
            float* to = tile(tile_of(half_edge)) + planes_.sides[side_of(half_edge)].high.at(i);
            float* from = tile(tile_of(mate)) + planes_.sides[side_of(mate)].high.at(planes_.h - 1 - i);
            for (size_t k = 0; k < 3; ++k) {
                to[k] += from[k];
                from[k] = 0;
            }
        }
    }

    const QuadComplex& complex_;
    const TilePlanes& planes_;
    float* samples_;
    std::vector<float> sums_;
    float factor_ = 0;
};

}  // namespace

template <class Wavelet>
TilePyramid<float> restore_tiles_transposed(const QuadComplex& complex, std::vector<float> grids, uint32_t exponent) {
    const auto step = [&](const TilePlanes& planes, float* samples) {
        Transpose<Wavelet>(complex, planes, samples).run();
    };
    return split_tiles(complex, std::move(grids), exponent, step, true);
}

template TilePyramid<float> restore_tiles_transposed<Tiles97>(const QuadComplex&, std::vector<float>, uint32_t);
template TilePyramid<float> restore_tiles_transposed<TilesSharp>(const QuadComplex&, std::vector<float>, uint32_t);

}  // namespace gim

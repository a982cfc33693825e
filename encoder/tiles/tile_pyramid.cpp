#include "encoder/tiles/tile_pyramid.h"

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

#include "encoder/code/dead_zone.h"
#include "format/tile_base.h"
#include "format/tile_code.h"
#include "format/tile_frames.h"
#include "format/tile_lifting.h"
#include "format/tile_norms.h"

namespace gim {
namespace {

// Between steps a constant image keeps its value.
template <class Wavelet>
void scale_low(const QuadComplex& complex, const TilePlanes& planes, bool up, typename Wavelet::Sample* samples) {
    if constexpr (!std::is_integral_v<typename Wavelet::Sample>) {
        if (Wavelet::kLowGain == 1) return;
        for (uint32_t t = 0; t < complex.tiles; ++t) {
            float* low = samples + t * planes.size();
            for (ptrdiff_t i = 0; i < planes.horizontal(); ++i)
                low[i] = up ? low[i] * Wavelet::kLowGain : low[i] / Wavelet::kLowGain;
        }
    }
}

// Sets the small images of the first step.
template <class Sample>
std::vector<Sample> planes_of_base(const QuadComplex& complex, const std::vector<Sample>& base) {
    const TilePlanes planes(1);
    std::vector<Sample> samples(complex.tiles * planes.size());
    for (uint32_t h = 0; h < complex.half_edges(); ++h)
        std::copy_n(
            base.begin() + 3 * ptrdiff_t{complex.vertex[h]}, 3,
            samples.begin() + static_cast<ptrdiff_t>(tile_of(h) * planes.size()) + planes.sides[side_of(h)].low.at(0));
    return samples;
}

// Undoes a step and makes the small images of the next one, or the grids if `planes` is the last.
template <class Wavelet>
std::vector<typename Wavelet::Sample> synthesize_step(const QuadComplex& complex, const TilePlanes& planes,
                                                      bool is_last, std::vector<typename Wavelet::Sample> samples) {
    using Sample = typename Wavelet::Sample;
    std::vector<typename Wavelet::Sum> sums(6 * size_t{complex.vertices});
    scale_low<Wavelet>(complex, planes, true, samples.data());
    TileLifting<Wavelet>(complex, planes, samples.data(), sums.data()).synthesize();
    const size_t stride = is_last ? planes.size() : TilePlanes(2 * planes.h).size();
    std::vector<Sample> next(complex.tiles * stride);
    for (uint32_t t = 0; t < complex.tiles; ++t)
        join_planes(planes, samples.data() + t * planes.size(), next.data() + t * stride);
    return next;
}

// One step of quantize_tiles or decode_tiles. The planes have the small images.
class StepQuantizer {
  public:
    StepQuantizer(const QuadComplex& complex, const TilePlanes& planes, const DetailSteps& steps,
                  std::vector<float>& samples)
        : complex_(complex), planes_(planes), steps_(steps), samples_(samples) {}

    // Returns the integers; puts what a decoder makes of them into the planes.
    std::vector<int32_t> run(const std::vector<float>& details) {
        find_frames(details.size() / 3);
        local_ = details;
        for_each([&](uint32_t, Orientation, uint32_t, uint32_t, size_t i) {
            const Frame& f = frames_[i / 3];
            into_frame(f.frame, &details[i], &local_[i]);
            for (size_t k = 0; k < 3; ++k) local_[i + k] /= f.step[k];
        });
        share(local_);
        std::vector<int32_t> integers = round();
        put(integers);
        return integers;
    }

    // Puts what a decoder makes of the integers into the planes.
    void decode(const std::vector<int32_t>& integers) {
        find_frames(integers.size() / 3);
        put(integers);
    }

  private:
    struct Frame {
        DetailFrame frame;
        std::array<float, 3> step;
    };

    void find_frames(size_t count) {
        frames_.resize(count);
        const TileFrames field(complex_, planes_, samples_.data());
        for_each([&](uint32_t tile, Orientation orientation, uint32_t row, uint32_t column, size_t i) {
            Frame& f = frames_[i / 3];
            f.frame = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1};
            f.step.fill(steps_.of(orientation));
            if (steps_.in_frames) {
                f.frame = field.at(tile, orientation, row, column, steps_.cell_area);
                steps_in(f.frame, steps_, orientation, f.step.data());
            }
        });
    }

    void put(const std::vector<int32_t>& integers) const {
        for_each([&](uint32_t tile, Orientation, uint32_t, uint32_t, size_t i) {
            float local[3];
            for (size_t k = 0; k < 3; ++k) local[k] = dequantize(integers[i + k], frames_[i / 3].step[k]);
            out_of_frame(frames_[i / 3].frame, local, &samples_[place_of(tile, i)]);
        });
    }

    size_t place_of(uint32_t tile, size_t i) const {
        return tile * planes_.size() + static_cast<size_t>(planes_.horizontal()) + (i - tile * planes_.details());
    }

    // Calls f(tile, orientation, row, column, index) for the details that are coded.
    template <class F>
    void for_each(const F& f) const {
        const uint32_t h = planes_.h;
        size_t i = 0;
        for (uint32_t t = 0; t < complex_.tiles; ++t) {
            const auto is_known = [&](uint32_t side) { return complex_.mate[4 * t + side] < 4 * t + side; };
            for (const Orientation o : {Orientation::kHorizontal, Orientation::kVertical, Orientation::kDiagonal}) {
                const uint32_t rows = h + (o == Orientation::kHorizontal), columns = h + (o == Orientation::kVertical);
                for (uint32_t row = 0; row < rows; ++row) {
                    for (uint32_t column = 0; column < columns; ++column, i += 3) {
                        const bool known = o == Orientation::kHorizontal
                                               ? (row == 0 && is_known(0)) || (row == h && is_known(2))
                                               : o == Orientation::kVertical &&
                                                     ((column == 0 && is_known(3)) || (column == h && is_known(1)));
                        if (!known) f(t, o, row, column, i);
                    }
                }
            }
        }
    }

    // Gives the other tile of an edge its details, along its own axes.
    void share(std::vector<float>& details) const {
        for (uint32_t e = 0; e < complex_.edges; ++e) {
            const uint32_t h = complex_.lower[e], mate = complex_.mate[h];
            if (mate == kNoMate) continue;
            float* own = details.data() + tile_of(h) * planes_.details() - planes_.horizontal();
            float* other = details.data() + tile_of(mate) * planes_.details() - planes_.horizontal();
            for (uint32_t i = 0; i < planes_.h; ++i) {
                const float* from = own + planes_.sides[side_of(h)].high.at(i);
                float* to = other + planes_.sides[side_of(mate)].high.at(planes_.h - 1 - i);
                if (steps_.in_frames)
                    turn_detail(side_of(h), side_of(mate), from, to);
                else
                    std::copy_n(from, 3, to);
            }
        }
    }

    std::vector<int32_t> round() const {
        std::vector<int32_t> integers;
        integers.reserve(local_.size());
        const uint32_t h = planes_.h;
        for (size_t at = 0; at < local_.size();) {
            for (const auto& [rows, columns] : {std::pair{h + 1, h}, std::pair{h, h + 1}, std::pair{h, h}}) {
                const size_t count = 3 * size_t{rows} * columns;
                const auto rounded =
                    round_band({std::span(local_).subspan(at, count), rows, columns}, steps_.in_frames);
                integers.insert(integers.end(), rounded.begin(), rounded.end());
                at += count;
            }
        }
        return integers;
    }

    const QuadComplex& complex_;
    const TilePlanes& planes_;
    const DetailSteps& steps_;
    std::vector<float>& samples_;
    std::vector<Frame> frames_;
    std::vector<float> local_;  // in frames, in steps
};

}  // namespace

template <class Wavelet>
void analyse_step(const QuadComplex& complex, const TilePlanes& planes, typename Wavelet::Sample* samples,
                  typename Wavelet::Sum* sums) {
    TileLifting<Wavelet>(complex, planes, samples, sums).analyse();
    scale_low<Wavelet>(complex, planes, false, samples);
}

template <class Wavelet>
TilePyramid<typename Wavelet::Sample> analyse_tiles(const QuadComplex& complex,
                                                    std::vector<typename Wavelet::Sample> grids, uint32_t exponent) {
    using Sample = typename Wavelet::Sample;
    std::vector<typename Wavelet::Sum> sums(6 * size_t{complex.vertices});
    return split_tiles(complex, std::move(grids), exponent, [&](const TilePlanes& planes, Sample* samples) {
        analyse_step<Wavelet>(complex, planes, samples, sums.data());
    });
}

template <class Wavelet>
std::vector<typename Wavelet::Sample> restore_tiles(const QuadComplex& complex,
                                                    const TilePyramid<typename Wavelet::Sample>& pyramid) {
    auto samples = planes_of_base(complex, pyramid.base);
    for (uint32_t step = 1; step <= pyramid.steps(); ++step) {
        const TilePlanes planes(1u << (step - 1));
        for (uint32_t t = 0; t < complex.tiles; ++t)
            std::copy_n(pyramid.details[step - 1].begin() + static_cast<ptrdiff_t>(t * planes.details()),
                        planes.details(),
                        samples.begin() + static_cast<ptrdiff_t>(t * planes.size()) + planes.horizontal());
        samples = synthesize_step<Wavelet>(complex, planes, step == pyramid.steps(), std::move(samples));
    }
    return samples;
}

template <class Wavelet>
TilePyramid<int32_t> quantize_tiles(const QuadComplex& complex, const TileShape& shape,
                                    const TilePyramid<float>& pyramid, const DetailCoding& coding,
                                    std::vector<float>* decoded) {
    TilePyramid<int32_t> out;
    const uint32_t steps = pyramid.steps();
    const float base_step = tile_base_step(shape, coding.quantizer);
    out.base = quantize_base(pyramid.base, base_step);
    std::vector<float> base;
    for (int32_t& q : out.base) {
        q = std::clamp(q, -kMostBaseValue, kMostBaseValue);
        base.push_back(static_cast<float>(q) * base_step);
    }
    std::vector<float> samples = planes_of_base(complex, base);
    for (uint32_t step = 1; step <= steps; ++step) {
        const TilePlanes planes(1u << (step - 1));
        const DetailSteps detail_steps = tile_steps_at(shape, coding, steps - step + 1);
        out.details.push_back(StepQuantizer(complex, planes, detail_steps, samples).run(pyramid.details[step - 1]));
        if (step < steps || decoded != nullptr)
            samples = synthesize_step<Wavelet>(complex, planes, step == steps, std::move(samples));
    }
    if (decoded != nullptr) *decoded = std::move(samples);
    return out;
}

template <class Wavelet>
std::vector<std::vector<float>> decode_tiles(const QuadComplex& complex, const TileShape& shape,
                                             const TilePyramid<int32_t>& pyramid, const DetailCoding& coding) {
    const uint32_t steps = pyramid.steps();
    std::vector<float> base;
    for (const int32_t q : pyramid.base)
        base.push_back(static_cast<float>(q) * tile_base_step(shape, coding.quantizer));
    std::vector<std::vector<float>> levels = {planes_of_base(complex, base)};
    for (uint32_t step = 1; step <= steps; ++step) {
        const TilePlanes planes(1u << (step - 1));
        const DetailSteps detail_steps = tile_steps_at(shape, coding, steps - step + 1);
        std::vector<float> samples = levels.back();
        StepQuantizer(complex, planes, detail_steps, samples).decode(pyramid.details[step - 1]);
        levels.push_back(synthesize_step<Wavelet>(complex, planes, step == steps, std::move(samples)));
    }
    return levels;
}

template void analyse_step<Tiles97>(const QuadComplex&, const TilePlanes&, float*, float*);
template void analyse_step<TilesSharp>(const QuadComplex&, const TilePlanes&, float*, float*);
template TilePyramid<int32_t> analyse_tiles<Tiles53>(const QuadComplex&, std::vector<int32_t>, uint32_t);
template TilePyramid<float> analyse_tiles<Tiles97>(const QuadComplex&, std::vector<float>, uint32_t);
template TilePyramid<float> analyse_tiles<TilesSharp>(const QuadComplex&, std::vector<float>, uint32_t);
template std::vector<int32_t> restore_tiles<Tiles53>(const QuadComplex&, const TilePyramid<int32_t>&);
template std::vector<float> restore_tiles<Tiles97>(const QuadComplex&, const TilePyramid<float>&);
template std::vector<float> restore_tiles<TilesSharp>(const QuadComplex&, const TilePyramid<float>&);
template TilePyramid<int32_t> quantize_tiles<Tiles97>(const QuadComplex&, const TileShape&, const TilePyramid<float>&,
                                                      const DetailCoding&, std::vector<float>*);
template TilePyramid<int32_t> quantize_tiles<TilesSharp>(const QuadComplex&, const TileShape&,
                                                         const TilePyramid<float>&, const DetailCoding&,
                                                         std::vector<float>*);
template std::vector<std::vector<float>> decode_tiles<Tiles97>(const QuadComplex&, const TileShape&,
                                                               const TilePyramid<int32_t>&, const DetailCoding&);
template std::vector<std::vector<float>> decode_tiles<TilesSharp>(const QuadComplex&, const TileShape&,
                                                                  const TilePyramid<int32_t>&, const DetailCoding&);

}  // namespace gim

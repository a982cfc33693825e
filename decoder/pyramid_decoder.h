// Streams -> bands -> inverse wavelet: the part of decoding that positions and attribute planes share.
#pragma once

#include <algorithm>
#include <cstring>
#include <new>
#include <span>

#include "decoder/arena.h"
#include "decoder/range_decoder.h"
#include "decoder/synthesis.h"
#include "format/status.h"

namespace gim {

// Memory for one pyramid, laid out in the caller's scratch.
struct PyramidWorkspace {
    BandModels* models = nullptr;
    BandWork band_work;
    int32_t* bands[2] = {};  // of the level being decoded and of its parent, in turn
    void* images[2] = {};    // int32_t or float triples, in turn; the requested level ends in images[0]
    void* synthesis = nullptr;
};

// side: of the level that is asked for.
PyramidWorkspace lay_out_pyramid(uint32_t side, Arena* arena);

struct PyramidShape {
    uint32_t exponent = 0;  // the full side is 2^exponent + 1
    uint32_t level = 0;     // the requested side is 2^(exponent - level) + 1
    float quantizer = 0;    // 9/7 only
    int32_t middle = 0;     // what base samples are stored relative to
};

inline constexpr float kLargestUnit = 0x1p22f;  // writers stay well below; keeps all later arithmetic finite

// Places the three bands of the level of side 2h+1 in one array.
inline LevelBands bands_in(int32_t* memory, uint32_t h) {
    LevelBands bands;
    bands.horizontal = {memory, h + 1, h};
    bands.vertical = {bands.horizontal.values + bands.horizontal.count(), h, h + 1};
    bands.diagonal = {bands.vertical.values + bands.vertical.count(), h, h};
    return bands;
}

inline size_t band_count(uint32_t side) {
    const size_t n = side, low = side / 2 + 1;
    return (n * n - low * low) * 3;
}

// Decodes the streams from the coarsest level down to the requested one.
template <class Wavelet>
class PyramidDecoder {
  public:
    using Sample = typename Wavelet::Sample;

    PyramidDecoder(const PyramidShape& shape, const PyramidWorkspace& ws) : shape_(shape), ws_(ws) {
        new (ws_.models) BandModels();
    }

    // One stream, down to that level; the first one begins with the 2x2 base and has several steps.
    Status decode_stream(std::span<const uint8_t> stream, uint32_t stream_level) {
        RangeDecoder coder(stream);
        BandCoder<RangeDecoder> band_coder(&coder, ws_.models, ws_.band_work);
        const uint32_t stream_exponent = shape_.exponent - stream_level;
        if (done_ == 0) decode_base(band_coder);
        while (ok_ && done_ < stream_exponent) decode_step(band_coder, ++done_);
        return ok_ && coder.intact() ? Status::kOk : Status::kMalformed;
    }

  private:
    // Images and bands alternate so that the last ones of the requested level fall on slot 0.
    uint32_t slot(uint32_t exponent) const { return (shape_.exponent - shape_.level - exponent) & 1; }
    Sample* image(uint32_t exponent) const { return static_cast<Sample*>(ws_.images[slot(exponent)]); }

    void decode_base(BandCoder<RangeDecoder>& coder) {
        const Band base = {ws_.bands[slot(0)], 2, 2};
        ok_ = coder.code_base(base);
        Sample* values = image(0);
        const float step = low_band_step(shape_.quantizer, shape_.exponent);
        for (size_t i = 0; i < base.count(); ++i) {
            if constexpr (Wavelet::kSteps == 2) {
                values[i] = base.values[i] + shape_.middle;
            } else {
                values[i] = static_cast<float>(base.values[i]) * step + static_cast<float>(shape_.middle);
            }
        }
    }

    void decode_step(BandCoder<RangeDecoder>& coder, uint32_t exponent) {
        const uint32_t h = 1u << (exponent - 1);
        const LevelBands bands = bands_in(ws_.bands[slot(exponent)], h);
        LevelBands parents;
        const bool has_parents = exponent > 1;
        if (has_parents) parents = bands_in(ws_.bands[slot(exponent - 1)], h / 2);
        ok_ = coder.code_level(bands, has_parents ? &parents : nullptr);
        if (!ok_) return;
        BandSteps steps;
        if constexpr (Wavelet::kSteps > 2) {
            const uint32_t depth = shape_.exponent - exponent + 1;
            steps.edge = band_step(shape_.quantizer, depth, Orientation::kHorizontal);
            steps.diagonal = band_step(shape_.quantizer, depth, Orientation::kDiagonal);
        }
        synthesize<Wavelet>(2 * h + 1, image(exponent - 1), bands, steps, static_cast<Sample*>(ws_.synthesis),
                            image(exponent));
    }

    PyramidShape shape_;
    const PyramidWorkspace& ws_;
    uint32_t done_ = 0;  // exponent of the finest side that is there
    bool ok_ = true;
};

// Integers or floats in place to bounded floats. By memcpy: the two types share the memory.
template <class Sample>
float* to_units(void* memory, size_t count) {
    auto* bytes = static_cast<std::byte*>(memory);
    constexpr size_t kBlock = 256;
    Sample from[kBlock];
    float to[kBlock];
    for (size_t i = 0; i < count; i += kBlock) {
        const size_t n = std::min(kBlock, count - i);
        std::memcpy(from, bytes + i * 4, n * 4);
        for (size_t k = 0; k < n; ++k)
            to[k] = std::min(std::max(static_cast<float>(from[k]), -kLargestUnit), kLargestUnit);
        std::memcpy(bytes + i * 4, to, n * 4);
    }
    return static_cast<float*>(memory);
}

}  // namespace gim

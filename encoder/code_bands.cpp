#include "encoder/code_bands.h"

#include <algorithm>
#include <cmath>

#include "encoder/range_encoder.h"

namespace gim {
namespace {

// A magnitude is rounded down when its fraction is below this. More than one half: a small coefficient costs more bits
// than it takes away error. Measured on the development models (spec/rationale.md).
constexpr float kRoundUpFrom = 0.6f;

std::vector<int32_t> quantize(const std::vector<float>& values, float step, float round_up_from) {
    std::vector<int32_t> out(values.size());
    for (size_t i = 0; i < values.size(); ++i) {
        const float magnitude = std::floor(std::abs(values[i]) / step + (1.0f - round_up_from));
        // The coder's bound; only reached by absurdly small steps.
        const auto q = static_cast<int32_t>(std::min(magnitude, 0x1p24f));
        out[i] = values[i] < 0 ? -q : q;
    }
    return out;
}

}  // namespace

Pyramid<int32_t> quantize_bands(const Pyramid<float>& pyramid, float quantizer) {
    Pyramid<int32_t> out;
    out.side = pyramid.side;
    const auto count = static_cast<uint32_t>(pyramid.levels.size());
    out.base = quantize(pyramid.base, low_band_step(quantizer, count), 0.5f);
    for (uint32_t e = 1; e <= count; ++e) {
        const AnalysisLevel<float>& level = pyramid.levels[e - 1];
        const float edge = band_step(quantizer, count - e + 1, Orientation::kHorizontal);
        const float diagonal = band_step(quantizer, count - e + 1, Orientation::kDiagonal);
        out.levels.push_back({quantize(level.horizontal, edge, kRoundUpFrom),
                              quantize(level.vertical, edge, kRoundUpFrom),
                              quantize(level.diagonal, diagonal, kRoundUpFrom)});
    }
    return out;
}

std::vector<std::vector<uint8_t>> code_bands(Pyramid<int32_t>& pyramid, uint32_t level_count) {
    const auto exponent = static_cast<uint32_t>(pyramid.levels.size());
    const uint32_t half = pyramid.side / 2 + 1;
    BandModels models;
    std::vector<uint32_t> rows(BandWork::row_size(half) * 3);
    std::vector<uint8_t> flags(BandWork::block_size(half));
    const BandWork work = {rows.data(), rows.data() + BandWork::row_size(half),
                           rows.data() + 2 * BandWork::row_size(half), flags.data()};
    std::vector<std::vector<uint8_t>> streams;
    uint32_t done = 0;
    for (uint32_t level = level_count; level-- > 0;) {
        RangeEncoder coder;
        BandCoder<RangeEncoder> band_coder(&coder, &models, work);
        if (done == 0) band_coder.code({pyramid.base.data(), 2, 2}, nullptr);
        for (; done < exponent - level; ++done) {
            const uint32_t h = 1u << done;
            AnalysisLevel<int32_t>& bands = pyramid.levels[done];
            AnalysisLevel<int32_t>* parents = done > 0 ? &pyramid.levels[done - 1] : nullptr;
            const auto code = [&](std::vector<int32_t>& band, std::vector<int32_t>* parent, uint32_t r, uint32_t c) {
                const Band parent_band = {parent ? parent->data() : nullptr, r / 2 + r % 2, c / 2 + c % 2};
                band_coder.code({band.data(), r, c}, parent ? &parent_band : nullptr);
            };
            code(bands.horizontal, parents ? &parents->horizontal : nullptr, h + 1, h);
            code(bands.vertical, parents ? &parents->vertical : nullptr, h, h + 1);
            code(bands.diagonal, parents ? &parents->diagonal : nullptr, h, h);
        }
        streams.push_back(coder.finish());
    }
    return streams;
}

}  // namespace gim

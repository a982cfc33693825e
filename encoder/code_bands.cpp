#include "encoder/code_bands.h"

#include <algorithm>
#include <cmath>

#include "encoder/range_encoder.h"

namespace gim {
namespace {

// Dead zone. A magnitude is rounded up from this fraction on ...
constexpr float kRoundUpFrom = 0.55f;
// ... but a single step is left out up to this much more where the neighbours are small, for there it costs most bits.
constexpr float kLonely = 0.2f;
constexpr float kNotLonelyFrom = 0.5f;  // mean magnitude of the neighbours, in steps
// The three were measured on the development models; so was the decoder's reconstruction shift (spec/rationale.md).

// Largest coefficient that the coder takes; only reached by absurdly small steps.
constexpr float kMaxMagnitude = 0x1p24f;

struct RealBand {
    const std::vector<float>& values;
    uint32_t rows, columns;

    float magnitude(uint32_t row, uint32_t column, uint32_t k) const {
        return std::abs(values[(size_t{row} * columns + column) * 3 + k]);
    }
};

// Mean over the eight neighbours and the two other components, each counted as four steps at most.
float mean_neighbour(const RealBand& band, uint32_t row, uint32_t column, uint32_t k, float step) {
    const float most = 4 * step;
    float sum = 0;
    for (uint32_t other = 0; other < 3; ++other) {
        if (other != k) sum += std::min(band.magnitude(row, column, other), most);
    }
    for (uint32_t r = row - std::min(row, 1u); r <= std::min(row + 1, band.rows - 1); ++r) {
        for (uint32_t c = column - std::min(column, 1u); c <= std::min(column + 1, band.columns - 1); ++c) {
            if (r != row || c != column) sum += std::min(band.magnitude(r, c, k), most);
        }
    }
    return sum / (10 * step);
}

std::vector<int32_t> quantize(const RealBand& band, float step) {
    std::vector<int32_t> out(band.values.size());
    for (uint32_t row = 0, i = 0; row < band.rows; ++row) {
        for (uint32_t column = 0; column < band.columns; ++column) {
            for (uint32_t k = 0; k < 3; ++k, ++i) {
                const float steps = band.magnitude(row, column, k) / step;
                if (steps < kRoundUpFrom) continue;
                float magnitude = std::floor(steps + (1.0f - kRoundUpFrom));
                if (magnitude == 1 && steps < kRoundUpFrom + kLonely) {
                    const float lonely = 1.0f - mean_neighbour(band, row, column, k, step) / kNotLonelyFrom;
                    if (steps < kRoundUpFrom + kLonely * lonely) magnitude = 0;
                }
                const auto q = static_cast<int32_t>(std::min(magnitude, kMaxMagnitude));
                out[i] = band.values[i] < 0 ? -q : q;
            }
        }
    }
    return out;
}

// The base is not sparse: plain rounding.
std::vector<int32_t> quantize_base(const std::vector<float>& values, float step) {
    std::vector<int32_t> out;
    for (const float v : values)
        out.push_back(static_cast<int32_t>(std::floor(std::clamp(v / step, -kMaxMagnitude, kMaxMagnitude) + 0.5f)));
    return out;
}

// The integer bands that lead to side 2h+1.
LevelBands bands_of(AnalysisLevel<int32_t>& level, uint32_t h) {
    return {{level.horizontal.data(), h + 1, h}, {level.vertical.data(), h, h + 1}, {level.diagonal.data(), h, h}};
}

}  // namespace

Pyramid<int32_t> quantize_bands(const Pyramid<float>& pyramid, float quantizer) {
    Pyramid<int32_t> out;
    out.side = pyramid.side;
    const auto count = static_cast<uint32_t>(pyramid.levels.size());
    out.base = quantize_base(pyramid.base, low_band_step(quantizer, count));
    for (uint32_t e = 1; e <= count; ++e) {
        const uint32_t h = 1u << (e - 1);
        const AnalysisLevel<float>& level = pyramid.levels[e - 1];
        const float edge = band_step(quantizer, count - e + 1, Orientation::kHorizontal);
        const float diagonal = band_step(quantizer, count - e + 1, Orientation::kDiagonal);
        out.levels.push_back({quantize({level.horizontal, h + 1, h}, edge), quantize({level.vertical, h, h + 1}, edge),
                              quantize({level.diagonal, h, h}, diagonal)});
    }
    return out;
}

std::vector<std::vector<uint8_t>> code_bands(Pyramid<int32_t>& pyramid, uint32_t level_count) {
    const auto exponent = static_cast<uint32_t>(pyramid.levels.size());
    const uint32_t half = pyramid.side / 2 + 1;
    BandModels models;
    std::vector<int32_t> rows(BandWork::row_size(half) * 2);
    std::vector<uint32_t> expected(BandWork::row_size(half));
    std::vector<uint8_t> flags(BandWork::block_size(half));
    const BandWork work = {rows.data(), rows.data() + BandWork::row_size(half), expected.data(), flags.data()};
    std::vector<std::vector<uint8_t>> streams;
    uint32_t done = 0;
    for (uint32_t level = level_count; level-- > 0;) {
        RangeEncoder coder;
        BandCoder<RangeEncoder> band_coder(&coder, &models, work);
        if (done == 0) band_coder.code_base({pyramid.base.data(), 2, 2});
        for (; done < exponent - level; ++done) {
            const LevelBands bands = bands_of(pyramid.levels[done], 1u << done);
            if (done == 0) {
                band_coder.code_level(bands, nullptr);
            } else {
                const LevelBands parents = bands_of(pyramid.levels[done - 1], 1u << (done - 1));
                band_coder.code_level(bands, &parents);
            }
        }
        streams.push_back(coder.finish());
    }
    return streams;
}

}  // namespace gim

#include "encoder/code/dead_zone.h"

#include <algorithm>

namespace gim {
namespace {

// The dead zone. Its values were measured on the development models, like the decoder's reconstruction shift
// (spec/rationale.md). A magnitude is rounded up from this fraction on.
constexpr float kRoundUpFrom = 0.55f, kTangentialRoundUpFrom = 0.6f;
// A single step among small neighbours takes most bits. There the fraction rises by up to this much.
constexpr float kLonely = 0.2f;
constexpr float kNotLonelyFrom = 0.5f;  // mean magnitude of the neighbours, in steps

// Largest coefficient that the coder takes. Only absurdly small steps reach it.
constexpr float kMaxMagnitude = 0x1p24f;

// Returns the mean magnitude of the eight neighbours and the two other components. Each counts as four at most.
float mean_neighbour(const RealBand& band, uint32_t row, uint32_t column, uint32_t k) {
    constexpr float most = 4;
    float sum = 0;
    for (uint32_t other = 0; other < 3; ++other) {
        if (other != k) sum += std::min(band.magnitude(row, column, other), most);
    }
    for (uint32_t r = row - std::min(row, 1u); r <= std::min(row + 1, band.rows - 1); ++r) {
        for (uint32_t c = column - std::min(column, 1u); c <= std::min(column + 1, band.columns - 1); ++c) {
            if (r != row || c != column) sum += std::min(band.magnitude(r, c, k), most);
        }
    }
    return sum / 10;
}

}  // namespace

std::vector<int32_t> round_band(const RealBand& band, bool in_frames) {
    std::vector<int32_t> out(band.values.size());
    for (uint32_t row = 0, i = 0; row < band.rows; ++row) {
        for (uint32_t column = 0; column < band.columns; ++column) {
            for (uint32_t k = 0; k < 3; ++k, ++i) {
                const float steps = band.magnitude(row, column, k);
                const float from = in_frames && k > 0 ? kTangentialRoundUpFrom : kRoundUpFrom;
                if (steps < from) continue;
                float magnitude = std::floor(steps + (1.0f - from));
                if (magnitude == 1 && steps < from + kLonely) {
                    const float lonely = 1.0f - mean_neighbour(band, row, column, k) / kNotLonelyFrom;
                    if (steps < from + kLonely * lonely) magnitude = 0;
                }
                const auto q = static_cast<int32_t>(std::min(magnitude, kMaxMagnitude));
                out[i] = band.values[i] < 0 ? -q : q;
            }
        }
    }
    return out;
}

std::vector<int32_t> quantize_base(const std::vector<float>& values, float step) {
    std::vector<int32_t> out;
    for (const float v : values)
        out.push_back(static_cast<int32_t>(std::floor(std::clamp(v / step, -kMaxMagnitude, kMaxMagnitude) + 0.5f)));
    return out;
}

}  // namespace gim

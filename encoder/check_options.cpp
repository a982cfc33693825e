#include "encoder/check_options.h"

#include <cmath>
#include <string>

#include "encoder/fit/effort.h"
#include "format/chart_table.h"
#include "format/quad_complex.h"

namespace gim {

namespace {

constexpr uint32_t kLeastSide = 5, kLeastSamples = 1000, kMostPlaneSide = 4097;

}  // namespace

Result<void> check_options(const EncodeOptions& options) {
    const auto is_grid = [](uint32_t side) {
        return side >= kLeastSide && side <= kMostSide && ((side - 1) & (side - 2)) == 0;
    };
    const auto wrong = [](const std::string& what) { return Error{Stage::kInput, what}; };
    if (!is_grid(options.side))
        return wrong("the size must be 2^j + 1, from 5 to 8193 (257, 513, ...); not " + std::to_string(options.side));
    if (!is_grid(options.node_side)) {
        return wrong("the node grid must be 2^j + 1, from 5 to 8193; not " + std::to_string(options.node_side));
    }
    if (options.bits < 8 || options.bits > 20)
        return wrong("the bits must be from 8 to 20; not " + std::to_string(options.bits));
    const auto is_plane = [](uint32_t side) {
        return side == 0 || (side >= kLeastSide && side <= kMostPlaneSide && ((side - 1) & (side - 2)) == 0);
    };
    if (!is_plane(options.normal_side) || !is_plane(options.color_side.value_or(0)))
        return wrong("the sides of normal map and colours must be 2^j + 1, from 5 to 4097 (257, 513, ...), or 0");
    if (options.plane_quality && !(*options.plane_quality >= 0 && *options.plane_quality <= 100))
        return wrong("the quality of normal map and colours must be from 0 to 100");
    const double value = options.rate.value;
    switch (options.rate.kind) {
        case RateTarget::Kind::kQuality:
            if (!(value >= 0 && value <= 100)) return wrong("the quality must be from 0 to 100");
            break;
        case RateTarget::Kind::kPsnr:
            if (!(value > 0 && value <= 200)) return wrong("the PSNR must be above 0 and at most 200 dB");
            break;
        case RateTarget::Kind::kMaxError:
            if (!(value > 0 && std::isfinite(value))) return wrong("the largest error must be above 0, and finite");
            break;
        case RateTarget::Kind::kBytes:
            if (!(value >= 1)) return wrong("the number of bytes must be at least 1");
            break;
        case RateTarget::Kind::kLossless:
            break;
    }
    if (options.samples < kLeastSamples || options.samples > kMostSamples)
        return wrong("the samples must be from 1000 to 67108864; not " + std::to_string(options.samples));
    if (options.tiles > kMostTiles)
        return wrong("at most " + std::to_string(kMostTiles) + " tiles; not " + std::to_string(options.tiles));
    if (options.charts > kMaxCharts)
        return wrong("at most " + std::to_string(kMaxCharts) + " charts; not " + std::to_string(options.charts));
    if (options.effort < kLeastEffort || options.effort > kMostEffort)
        return wrong("the effort must be from 1 to 9; not " + std::to_string(options.effort));
    return {};
}

}  // namespace gim

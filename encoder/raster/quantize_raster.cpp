#include "encoder/raster/quantize_raster.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "encoder/code/file_units.h"
#include "encoder/surface/local_frame.h"

namespace gim {
namespace {

constexpr double kMostExactFloat = 1 << 24;  // binary32 holds all whole numbers up to here

Error error(std::string message) { return {Stage::kInput, std::move(message)}; }

std::string name_of(const RasterImage& image, size_t sample) {
    return "the sample at row " + std::to_string(sample / image.width) + ", column " +
           std::to_string(sample % image.width);
}

struct Range {
    double low = INFINITY, high = -INFINITY;
    bool is_whole = true;

    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
        is_whole = is_whole && value == std::floor(value);
    }
    double extent() const { return high - low; }
    // Of whole numbers.
    uint32_t bits() const { return extent() < 0x1p32 ? std::bit_width(static_cast<uint32_t>(extent())) : 33; }
};

std::vector<Range> ranges_of(const RasterImage& image) {
    std::vector<Range> ranges(image.channels);
    for (size_t i = 0; i < image.defined.size(); ++i) {
        if (!image.defined[i]) continue;
        for (uint32_t k = 0; k < image.channels; ++k) ranges[k].add(image.values[i * image.channels + k]);
    }
    return ranges;
}

Result<void> check(const RasterImage& image) {
    const uint64_t samples = uint64_t{image.width} * image.height;
    if (image.width < 2 || image.height < 2 || image.width > kMaxAtlasSide || image.height > kMaxAtlasSide ||
        samples > kMaxRasterSamples)
        return error("an image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                     " samples cannot be coded: 2 to 65536 a side are possible, and 2^31 in all");
    if (image.channels < kRasterGroup || image.channels > kMaxRasterChannels)
        return error("an image needs 3 to 4096 channels besides the mask, x y z first; this one has " +
                     std::to_string(image.channels));
    if (image.values.size() != samples * image.channels || image.defined.size() != samples)
        return error("the image has not as many values as its size says");
    if (std::none_of(image.defined.begin(), image.defined.end(), [](uint8_t d) { return d != 0; }))
        return error("the mask defines no sample");
    for (size_t i = 0; i < samples; ++i) {
        if (!image.defined[i]) continue;
        for (uint32_t k = 0; k < image.channels; ++k) {
            if (std::isfinite(image.values[i * image.channels + k])) continue;
            return error(name_of(image, i) + " is not finite in channel " + std::to_string(k) +
                         " and is defined by the mask; repair the image first");
        }
    }
    return {};
}

Result<RasterScale> whole_scale(std::span<const Range> axes) {
    RasterScale scale;
    scale.is_exact = true;
    uint32_t bits = kMinBits;
    bool is_wide = false;
    for (size_t k = 0; k < 3; ++k) {
        bits = std::max(bits, axes[k].bits());
        scale.low[k] = axes[k].low;
        scale.units.origin[k] = static_cast<float>(axes[k].low);
        is_wide = is_wide || std::abs(axes[k].low) > kMostExactFloat || std::abs(axes[k].high) > kMostExactFloat;
    }
    if (bits > kMaxBits)
        return error(
            "the positions are whole numbers of more than 20 bits; make them floats, and they are rounded to --bits");
    if (is_wide) scale.wide_origin = scale.low;
    scale.units.bits = bits;
    scale.units.step = 1;
    return scale;
}

Result<RasterScale> float_scale(const RasterImage& image, uint32_t bits) {
    std::vector<Vec3> points;
    std::vector<size_t> samples;
    for (size_t i = 0; i < image.defined.size(); ++i) {
        if (!image.defined[i]) continue;
        const double* v = &image.values[i * image.channels];
        points.emplace_back(v[0], v[1], v[2]);
        samples.push_back(i);
    }
    GIM_CHECK(check_extent(points, bits, Stage::kInput, [&](size_t i) { return name_of(image, samples[i]); }));
    const LocalFrame frame = choose_frame(points, bits);
    move_into(frame, points);
    const std::span<const Vec3> all = points;
    RasterScale scale;
    scale.units = units_of_box({&all, 1}, bits);
    if (frame.is_moved) {
        const auto& o = scale.units.origin;
        scale.wide_origin = {frame.origin.x() + double{o[0]}, frame.origin.y() + double{o[1]},
                             frame.origin.z() + double{o[2]}};
    }
    for (size_t k = 0; k < 3; ++k)
        scale.low[k] = scale.wide_origin ? (*scale.wide_origin)[k] : double{scale.units.origin[k]};
    return scale;
}

Result<RasterChannel> channel_scale(const Range& range, bool must_be_whole, uint32_t bits, uint32_t index) {
    const bool fits = range.is_whole && range.bits() <= kMaxBits && std::abs(range.low) <= kMostExactFloat;
    if (fits) return RasterChannel{std::max(range.bits(), 1u), static_cast<float>(range.low), 1};
    if (must_be_whole)
        return error("channel " + std::to_string(index) +
                     " has whole numbers of more than 20 bits; make them floats, and they are rounded to --bits");
    const auto origin = static_cast<float>(range.low);
    const auto step = static_cast<float>(range.extent() / (std::exp2(bits) - 1));
    if (!(std::abs(origin) <= kMaxOrigin) || !(step <= kMaxStep))
        return error("channel " + std::to_string(index) + " has numbers that are too large");
    return RasterChannel{bits, origin, std::max(step, kMinStep)};
}

}  // namespace

Result<RasterScale> scale_raster(const RasterImage& image, uint32_t bits) {
    GIM_CHECK(check(image));
    const std::vector<Range> ranges = ranges_of(image);
    const bool is_whole_type = is_whole(image.type);
    const bool is_whole_range = std::all_of(ranges.begin(), ranges.begin() + 3,
                                            [](const Range& r) { return r.is_whole && r.bits() <= kMaxBits; });
    auto scale = is_whole_type || is_whole_range ? whole_scale(std::span(ranges).first(3)) : float_scale(image, bits);
    if (!scale.ok()) return scale.error();
    for (uint32_t k = kRasterGroup; k < image.channels; ++k) {
        GIM_TRY(channel, channel_scale(ranges[k], is_whole_type, bits, k));
        scale.value().others.push_back(channel);
    }
    return scale;
}

std::vector<Vec3> raster_positions(const RasterImage& image) {
    std::vector<Vec3> positions(image.defined.size(), Vec3::Zero());
    for (size_t i = 0; i < positions.size(); ++i) {
        const double* v = &image.values[i * image.channels];
        if (image.defined[i]) positions[i] = {v[0], v[1], v[2]};
    }
    return positions;
}

std::vector<int32_t> quantized(const RasterImage& image, const RasterScale& scale, double quantizer) {
    const auto rounded = [](double value, uint32_t bits) {
        return static_cast<int32_t>(std::clamp(std::round(value), 0.0, std::exp2(bits) - 1));
    };
    std::vector<int32_t> numbers(image.values.size());
    for (size_t i = 0; i < image.defined.size(); ++i) {
        if (!image.defined[i]) continue;
        const double* v = &image.values[i * image.channels];
        int32_t* out = &numbers[i * image.channels];
        for (size_t k = 0; k < 3; ++k)
            out[k] = rounded((v[k] - scale.low[k]) / (double{scale.units.step} * quantizer), scale.units.bits);
        for (size_t k = 3; k < image.channels; ++k) {
            const RasterChannel& c = scale.others[k - 3];
            out[k] = rounded((v[k] - double{c.origin}) / double{c.step}, c.bits);
        }
    }
    return numbers;
}

}  // namespace gim

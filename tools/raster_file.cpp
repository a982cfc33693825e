#include "tools/raster_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include "gim/decoder.hpp"
#include "tools/decoded.h"
#include "tools/npz.h"

namespace gim {
namespace {

constexpr std::array<uint8_t, 4> kExrMagic = {0x76, 0x2F, 0x31, 0x01};
constexpr std::string_view kNamesKey = "channels: ";

// A lossy position may lie outside of what the type holds.
double as_type(double value, SampleType type) {
    const auto whole = [&](double low, double high) { return std::clamp(std::round(value), low, high); };
    switch (type) {
        case SampleType::kUint8:
            return whole(0, UINT8_MAX);
        case SampleType::kInt8:
            return whole(INT8_MIN, INT8_MAX);
        case SampleType::kUint16:
            return whole(0, UINT16_MAX);
        case SampleType::kInt16:
            return whole(INT16_MIN, INT16_MAX);
        case SampleType::kUint32:
            return whole(0, UINT32_MAX);
        case SampleType::kInt32:
            return whole(INT32_MIN, INT32_MAX);
        default:
            return value;
    }
}

std::vector<std::string> names_in(Decoder& decoder) {
    uint64_t size = 0;
    if (decoder.read_text_size(&size) != GIM_OK || size == 0 || size > (1 << 20)) return {};
    std::string text(size, '\0');
    if (decoder.text(text) != GIM_OK || !text.starts_with(kNamesKey)) return {};
    std::istringstream words(text.substr(kNamesKey.size()));
    std::vector<std::string> names;
    for (std::string name; words >> name;) names.push_back(name);
    return names;
}

}  // namespace

std::optional<RasterFormat> raster_format_of(std::span<const uint8_t> bytes, std::string_view extension) {
    if (is_npz(bytes)) return RasterFormat::kNpz;
    const bool begins_as_exr =
        bytes.size() >= kExrMagic.size() && std::equal(kExrMagic.begin(), kExrMagic.end(), bytes.begin());
    if (begins_as_exr || extension == "exr") return RasterFormat::kExr;
    return extension == "npz" ? std::optional(RasterFormat::kNpz) : std::nullopt;
}

Result<RasterImage> read_raster(std::span<const uint8_t> bytes, RasterFormat format, const RasterOptions& options,
                                MemoryBudget& memory) {
    return format == RasterFormat::kNpz ? read_raster_npz(bytes, options, memory) : read_raster_exr(bytes, memory);
}

Result<Bytes> write_raster_file(const RasterImage& image, RasterFormat format) {
    return format == RasterFormat::kNpz ? write_raster_npz(image) : write_raster_exr(image);
}

bool holds_raster(const Bytes& file) {
    gim_info info;
    gim_raster_info raster;
    return gim_read_info(file.data(), file.size(), nullptr, &info) == GIM_OK &&
           gim_read_raster_info(&info, file.data(), file.size(), &raster) == GIM_OK;
}

Result<RasterImage> decode_raster_image(const Bytes& file) {
    const auto failed = [](gim_status status) { return Error{Stage::kInput, describe_status(status)}; };
    Decoder decoder;
    if (const gim_status s = decoder.open(file); s != GIM_OK) return failed(s);
    const gim_info* info = &decoder.info();
    gim_raster_info raster;
    if (const gim_status s = gim_read_raster_info(info, file.data(), file.size(), &raster); s != GIM_OK)
        return failed(s);
    RasterImage image;
    image.width = raster.width;
    image.height = raster.height;
    image.channels = raster.channels;
    image.type = static_cast<SampleType>(raster.sample_type);
    image.is_channels_first = raster.is_channels_first != 0;
    image.mask = static_cast<RasterImage::Mask>(std::min<uint32_t>(raster.mask, GIM_MASK_CHANNEL));
    image.mask_channel = raster.mask >= GIM_MASK_CHANNEL ? raster.mask - GIM_MASK_CHANNEL : 0;
    image.mask_value = raster.mask_value;
    const size_t samples = size_t{raster.width} * raster.height;
    std::vector<int32_t> numbers(samples * raster.channels);
    image.defined.resize(samples);
    Scratch scratch(raster.scratch_size);
    if (const gim_status s = gim_decode_raster(info, file.data(), file.size(), numbers.data(), image.defined.data(),
                                               scratch.data(), scratch.size());
        s != GIM_OK)
        return failed(s);
    image.values.resize(numbers.size());
    for (uint32_t k = 0; k < raster.channels; ++k) {
        gim_raster_channel channel;
        if (const gim_status s = gim_read_raster_channel(info, file.data(), file.size(), k, &channel); s != GIM_OK)
            return failed(s);
        for (size_t i = k; i < numbers.size(); i += raster.channels)
            image.values[i] = as_type(channel.origin + channel.step * numbers[i], image.type);
    }
    image.names = names_in(decoder);
    return image;
}

}  // namespace gim

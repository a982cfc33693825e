// An image as NumPy arrays: positions, other channels and perhaps a mask in one array, or the mask in a second one.
#include <algorithm>
#include <cmath>

#include "tools/npz.h"
#include "tools/raster_file.h"

namespace gim {
namespace {

constexpr uint32_t kUsualMaskChannel = 3;

Error error(std::string message) { return {Stage::kInput, std::move(message)}; }

std::string shape_text(const NumberArray& array) {
    std::string text;
    for (const uint64_t n : array.shape) text += (text.empty() ? "" : " x ") + std::to_string(n);
    return text.empty() ? "one number" : text;
}

struct Arrays {
    const NumberArray* image = nullptr;
    const NumberArray* mask = nullptr;
};

Result<Arrays> choose_arrays(const std::vector<NamedArray>& arrays) {
    Arrays chosen;
    uint32_t images = 0;
    for (const auto& [name, array] : arrays) {
        if (name == "mask") {
            chosen.mask = &array;
            continue;
        }
        chosen.image = &array;
        ++images;
    }
    if (images != 1)
        return error("the .npz file has " + std::to_string(images) +
                     " arrays besides 'mask'; gim takes one image from a file");
    return chosen;
}

Result<bool> find_axis(const NumberArray& image, const NumberArray* mask, const RasterOptions& options) {
    const auto& s = image.shape;
    if (s.size() != 3)
        return error("the array has the shape " + shape_text(image) + "; an image has height, width and channels");
    if (options.is_channels_first) return *options.is_channels_first;
    if (mask && mask->shape.size() == 2) {
        const bool last = mask->shape[0] == s[0] && mask->shape[1] == s[1];
        const bool first = mask->shape[0] == s[1] && mask->shape[1] == s[2];
        if (last != first) return first;
    }
    if (s[2] >= 3 && s[2] < s[0]) return false;
    if (s[0] >= 3 && s[0] < s[2]) return true;
    return error("the shape " + shape_text(image) + " does not tell which axis holds the channels; say --channels");
}

struct Layout3 {
    uint64_t rows, columns, channels;
    bool is_channels_first;
    uint64_t at(uint64_t sample, uint64_t channel) const {
        return is_channels_first ? channel * rows * columns + sample : sample * channels + channel;
    }
};

// Sets who is defined, and how the array said so. Returns the channels that are data.
Result<std::vector<uint64_t>> read_mask(const Arrays& arrays, const Layout3& layout, const RasterOptions& options,
                                        RasterImage& image) {
    const uint64_t samples = layout.rows * layout.columns;
    std::vector<uint64_t> channels;
    for (uint64_t k = 0; k < layout.channels; ++k) channels.push_back(k);
    image.defined.assign(samples, 1);
    const auto& values = arrays.image->values;
    const bool has_nan = std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); });
    std::optional<uint32_t> channel = options.mask_channel;
    if (!channel && !options.no_mask && !arrays.mask && !has_nan && layout.channels > kUsualMaskChannel)
        channel = kUsualMaskChannel;
    std::vector<double> told;
    if (arrays.mask && !options.mask_channel && !options.no_mask) {
        if (arrays.mask->values.size() != samples)
            return error("the mask has the shape " + shape_text(*arrays.mask) + ", the image " +
                         std::to_string(layout.rows) + " x " + std::to_string(layout.columns));
        image.mask = RasterImage::Mask::kArray;
        told = arrays.mask->values;
    } else if (channel) {
        if (*channel >= layout.channels)
            return error("there is no channel " + std::to_string(*channel) + " for the mask; the array has " +
                         std::to_string(layout.channels));
        image.mask = RasterImage::Mask::kChannel;
        image.mask_channel = *channel;
        channels.erase(channels.begin() + *channel);
        for (uint64_t i = 0; i < samples; ++i) told.push_back(values[layout.at(i, *channel)]);
    } else {
        for (uint64_t i = 0; i < samples; ++i) {
            for (const uint64_t k : channels)
                if (std::isnan(values[layout.at(i, k)])) image.defined[i] = 0;
        }
        return channels;
    }
    double value = 0;
    for (uint64_t i = 0; i < samples; ++i) {
        image.defined[i] = told[i] != 0 ? 1 : 0;
        if (told[i] == 0) continue;
        if (value == 0) value = told[i];
        if (told[i] != value)
            return error("the mask has other values than 0 and " + std::to_string(value) +
                         "; name its channel with --mask-channel, or none if all channels are data");
    }
    if (value < 0 || value > UINT32_MAX || value != std::floor(value))
        return error("the mask has the value " + std::to_string(value) + "; 1 or another whole number is expected");
    image.mask_value = value == 0 ? 1 : static_cast<uint32_t>(value);
    return channels;
}

}  // namespace

Result<RasterImage> read_raster_npz(std::span<const uint8_t> bytes, const RasterOptions& options,
                                    MemoryBudget& memory) {
    const Result<std::vector<NamedArray>> read = read_npz(bytes, memory);
    if (!read.ok()) return read.error();
    const Result<Arrays> arrays = choose_arrays(read.value());
    if (!arrays.ok()) return arrays.error();
    const NumberArray& array = *arrays.value().image;
    const Result<bool> first = find_axis(array, arrays.value().mask, options);
    if (!first.ok()) return first.error();
    const auto& s = array.shape;
    const Layout3 layout = first.value() ? Layout3{s[1], s[2], s[0], true} : Layout3{s[0], s[1], s[2], false};
    if (layout.rows > UINT16_MAX + 1 || layout.columns > UINT16_MAX + 1 || layout.channels > UINT16_MAX)
        return error("an image of the shape " + shape_text(array) + " is too large");
    RasterImage image;
    image.height = static_cast<uint32_t>(layout.rows);
    image.width = static_cast<uint32_t>(layout.columns);
    image.type = array.type;
    image.is_channels_first = layout.is_channels_first;
    const Result<std::vector<uint64_t>> channels = read_mask(arrays.value(), layout, options, image);
    if (!channels.ok()) return channels.error();
    image.channels = static_cast<uint32_t>(channels.value().size());
    for (uint64_t i = 0; i < image.defined.size(); ++i) {
        for (const uint64_t k : channels.value()) image.values.push_back(array.values[layout.at(i, k)]);
    }
    return image;
}

Result<Bytes> write_raster_npz(const RasterImage& image) {
    const bool in_channel = image.mask == RasterImage::Mask::kChannel;
    const uint64_t channels = image.channels + (in_channel ? 1 : 0);
    const Layout3 layout = {image.height, image.width, channels, image.is_channels_first};
    NumberArray array;
    array.type = image.type;
    array.shape = layout.is_channels_first ? std::vector<uint64_t>{channels, layout.rows, layout.columns}
                                           : std::vector<uint64_t>{layout.rows, layout.columns, channels};
    array.values.assign(image.defined.size() * channels, 0.0);
    const bool as_nan = image.mask == RasterImage::Mask::kNowhere && !is_whole(image.type);
    for (uint64_t i = 0; i < image.defined.size(); ++i) {
        uint64_t place = 0;
        for (uint64_t k = 0; k < image.channels; ++k, ++place) {
            if (in_channel && place == image.mask_channel) ++place;
            array.values[layout.at(i, place)] =
                image.defined[i] ? image.values[i * image.channels + k] : (as_nan ? std::nan("") : 0.0);
        }
        if (in_channel) array.values[layout.at(i, image.mask_channel)] = image.defined[i] ? image.mask_value : 0;
    }
    std::vector<NamedArray> arrays;
    arrays.emplace_back("image", std::move(array));
    if (image.mask == RasterImage::Mask::kArray) {
        NumberArray mask;
        mask.is_bool = image.mask_value == 1;
        mask.type = image.mask_value < 256 ? SampleType::kUint8 : SampleType::kUint32;
        mask.shape = {image.height, image.width};
        for (const uint8_t d : image.defined) mask.values.push_back(d ? image.mask_value : 0);
        arrays.emplace_back("mask", std::move(mask));
    }
    return write_npz(arrays);
}

}  // namespace gim

// An image as OpenEXR: channels X Y Z or R G B, perhaps a mask, and others.
#include <Imath/half.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <exception>
#include <stdexcept>

#include "tools/exr_stream.h"
#include "tools/raster_file.h"

namespace gim {
namespace {

class ReadStream : public Imf::IStream {
  public:
    explicit ReadStream(std::span<const uint8_t> bytes) : Imf::IStream("memory"), bytes_(bytes) {}
    bool read(char c[], int n) override {
        const auto count = static_cast<size_t>(n);
        if (count > bytes_.size() - position_) throw std::runtime_error("the file ends too early");
        std::memcpy(c, bytes_.data() + position_, count);
        position_ += count;
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override {
        if (position > bytes_.size()) throw std::runtime_error("the file ends too early");
        position_ = position;
    }

  private:
    std::span<const uint8_t> bytes_;
    size_t position_ = 0;
};

Error error(std::string message) { return {Stage::kInput, std::move(message)}; }

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    return text;
}

struct NamedChannel {
    std::string name;
    Imf::PixelType type;
};

// The channels in the order of the image, and where the mask is among them.
struct Order {
    std::vector<NamedChannel> data;
    std::optional<NamedChannel> mask;
};

Result<Order> order_of(const Imf::ChannelList& list) {
    std::vector<NamedChannel> all;
    for (auto c = list.begin(); c != list.end(); ++c) {
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
            return error(std::string("channel ") + c.name() + " has fewer samples than the image");
        all.push_back({c.name(), c.channel().type});
    }
    Order order;
    const auto take = [&](const char* name) -> std::optional<NamedChannel> {
        const auto at =
            std::find_if(all.begin(), all.end(), [&](const NamedChannel& c) { return lower(c.name) == name; });
        if (at == all.end()) return {};
        const NamedChannel found = *at;
        all.erase(at);
        return found;
    };
    const bool is_xyz = list.findChannel("X") || list.findChannel("x");
    for (const char* name : is_xyz ? std::array{"x", "y", "z"} : std::array{"r", "g", "b"}) {
        const auto channel = take(name);
        if (!channel) return error("the EXR image has no channels X, Y, Z or R, G, B");
        order.data.push_back(*channel);
    }
    for (const char* name : {"mask", "alpha", "a"}) {
        if (!order.mask) order.mask = take(name);
    }
    order.data.insert(order.data.end(), all.begin(), all.end());
    return order;
}

SampleType type_of(const Order& order) {
    bool is_same = true;
    for (const NamedChannel& c : order.data) is_same = is_same && c.type == order.data[0].type;
    if (!is_same) return SampleType::kFloat32;
    return order.data[0].type == Imf::HALF   ? SampleType::kFloat16
           : order.data[0].type == Imf::UINT ? SampleType::kUint32
                                             : SampleType::kFloat32;
}

// Whole numbers are read as they are, floats as float32.
struct Plane {
    bool is_uint = false;
    std::vector<uint32_t> bits;

    double at(size_t i) const { return is_uint ? bits[i] : double{std::bit_cast<float>(bits[i])}; }
};

Result<void> set_mask(const Plane* mask, RasterImage& image) {
    for (size_t i = 0; i < image.defined.size(); ++i) {
        const double* v = &image.values[i * image.channels];
        const bool is_number = std::none_of(v, v + image.channels, [](double x) { return std::isnan(x); });
        image.defined[i] = is_number && (!mask || mask->at(i) != 0) ? 1 : 0;
        if (!mask || mask->at(i) == 0) continue;
        if (mask->at(i) != image.mask_value) return error("the channel of the mask has other values than 0 and 1");
    }
    return {};
}

Result<RasterImage> read(std::span<const uint8_t> bytes, MemoryBudget& memory) {
    ReadStream stream(bytes);
    Imf::InputFile file(stream);
    const Result<Order> order = order_of(file.header().channels());
    if (!order.ok()) return order.error();
    const Imath::Box2i window = file.header().dataWindow();
    const int64_t width = int64_t{window.max.x} - window.min.x + 1, height = int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 || width > UINT16_MAX + 1 || height > UINT16_MAX + 1)
        return error("an image of " + std::to_string(width) + " x " + std::to_string(height) + " cannot be coded");
    std::vector<NamedChannel> channels = order.value().data;
    if (order.value().mask) channels.push_back(*order.value().mask);
    const auto samples = static_cast<uint64_t>(width * height);
    if (const Result<void> fits = memory.take(samples * channels.size(), 12, "the channels of the image"); !fits.ok())
        return fits.error();

    std::vector<Plane> planes(channels.size());
    Imf::FrameBuffer frame;
    for (size_t k = 0; k < channels.size(); ++k) {
        planes[k].is_uint = channels[k].type == Imf::UINT;
        planes[k].bits.resize(samples);
        const auto row = static_cast<size_t>(width) * sizeof(uint32_t);
        char* const base = reinterpret_cast<char*>(planes[k].bits.data()) -
                           (int64_t{window.min.x} + int64_t{window.min.y} * width) * int64_t{sizeof(uint32_t)};
        frame.insert(channels[k].name,
                     Imf::Slice(planes[k].is_uint ? Imf::UINT : Imf::FLOAT, base, sizeof(uint32_t), row));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);

    RasterImage image;
    image.width = static_cast<uint32_t>(width);
    image.height = static_cast<uint32_t>(height);
    image.type = type_of(order.value());
    image.channels = static_cast<uint32_t>(order.value().data.size());
    image.mask = order.value().mask ? RasterImage::Mask::kArray : RasterImage::Mask::kNowhere;
    for (uint64_t i = 0; i < samples; ++i) {
        for (uint32_t k = 0; k < image.channels; ++k) image.values.push_back(planes[k].at(i));
    }
    image.defined.resize(samples);
    for (const NamedChannel& c : channels) image.names.push_back(c.name);
    const bool is_usual =
        image.channels == 3 && image.names[0] == "X" && (!order.value().mask || order.value().mask->name == "mask");
    if (is_usual) image.names.clear();
    const Result<void> masked = set_mask(order.value().mask ? &planes.back() : nullptr, image);
    if (!masked.ok()) return masked.error();
    return image;
}

Imf::PixelType pixel_type(SampleType type) {
    if (type == SampleType::kFloat16) return Imf::HALF;
    return type == SampleType::kUint8 || type == SampleType::kUint16 || type == SampleType::kUint32 ? Imf::UINT
                                                                                                    : Imf::FLOAT;
}

// The names of all channels, that of the mask last.
std::vector<std::string> names_of(const RasterImage& image) {
    std::vector<std::string> names = image.names;
    if (names.size() != image.channels && names.size() != image.channels + 1) {
        names = {"X", "Y", "Z"};
        for (uint32_t k = 3; k < image.channels; ++k) names.push_back("C" + std::to_string(k));
    }
    if (names.size() == image.channels) names.emplace_back("mask");
    return names;
}

void write(const RasterImage& image, ExrStream& stream) {
    const std::vector<std::string> names = names_of(image);
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer frame;
    std::vector<std::vector<uint32_t>> planes(names.size(), std::vector<uint32_t>(image.defined.size()));
    for (size_t k = 0; k < names.size(); ++k) {
        const bool is_mask = k == image.channels;
        const Imf::PixelType type = is_mask ? Imf::FLOAT : pixel_type(image.type);
        const double hole =
            is_mask || image.mask != RasterImage::Mask::kNowhere || is_whole(image.type) ? 0 : std::nan("");
        for (size_t i = 0; i < image.defined.size(); ++i) {
            const double value = !image.defined[i] ? hole : is_mask ? 1.0 : image.values[i * image.channels + k];
            planes[k][i] = type == Imf::UINT   ? static_cast<uint32_t>(value)
                           : type == Imf::HALF ? Imath::half(static_cast<float>(value)).bits()
                                               : std::bit_cast<uint32_t>(static_cast<float>(value));
        }
        header.channels().insert(names[k], Imf::Channel(type));
        // A half is in the lower bytes, which come first on little-endian machines.
        char* base = reinterpret_cast<char*>(planes[k].data());
        if (type == Imf::HALF && std::endian::native == std::endian::big) base += sizeof(uint16_t);
        frame.insert(names[k], Imf::Slice(type, base, sizeof(uint32_t), sizeof(uint32_t) * size_t{image.width}));
    }
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(frame);
    file.writePixels(static_cast<int>(image.height));
}

}  // namespace

Result<RasterImage> read_raster_exr(std::span<const uint8_t> bytes, MemoryBudget& memory) {
    try {
        return read(bytes, memory);
    } catch (const std::exception& failure) {
        return error(std::string("OpenEXR: ") + failure.what());
    }
}

Result<Bytes> write_raster_exr(const RasterImage& image) {
    ExrStream stream;
    try {
        write(image, stream);
    } catch (const std::exception& failure) {
        return Error{Stage::kWrite, std::string("OpenEXR: ") + failure.what()};
    }
    return std::move(stream.bytes);
}

}  // namespace gim

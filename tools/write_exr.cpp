// OpenEXR: float32 channels X, Y, Z (with the cut closed) and mask (1 if the sample is defined). One part per image. If
// positions are relative to an origin, the attribute gimOrigin has it.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfVecAttribute.h>

#include <algorithm>
#include <exception>
#include <string>

#include "tools/exr_stream.h"
#include "tools/surface_write.h"

namespace gim {
namespace {

// The parts of one file must agree on the display window; the data windows may differ.
Imath::Box2i window_of(uint32_t columns, uint32_t rows) {
    return {Imath::V2i(0, 0), Imath::V2i(static_cast<int>(columns) - 1, static_cast<int>(rows) - 1)};
}
Imf::Header header_of(const DecodedImage& image, const Imath::Box2i& display) {
    Imf::Header header(display, window_of(image.columns, image.rows));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const char* name : {"X", "Y", "Z", "mask"}) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    const auto& o = image.origin;
    if (image.is_relative()) header.insert("gimOrigin", Imf::V3dAttribute(Imath::V3d(o[0], o[1], o[2])));
    return header;
}

// OpenEXR only reads from the slices, but asks for char*.
char* base_of(const float* values) { return const_cast<char*>(reinterpret_cast<const char*>(values)); }

Imf::FrameBuffer frame_of(const DecodedImage& image, const std::vector<float>& mask) {
    Imf::FrameBuffer frame;
    const size_t row = size_t{image.columns} * sizeof(float);
    frame.insert("X", Imf::Slice(Imf::FLOAT, base_of(image.grid.data()), 3 * sizeof(float), 3 * row));
    frame.insert("Y", Imf::Slice(Imf::FLOAT, base_of(image.grid.data() + 1), 3 * sizeof(float), 3 * row));
    frame.insert("Z", Imf::Slice(Imf::FLOAT, base_of(image.grid.data() + 2), 3 * sizeof(float), 3 * row));
    frame.insert("mask", Imf::Slice(Imf::FLOAT, base_of(mask.data()), sizeof(float), row));
    return frame;
}

// 1 if a sample is defined, else 0.
std::vector<float> mask_of(const DecodedImage& image) {
    std::vector<float> mask(image.grid.size() / 3);
    for (size_t i = 0; i < mask.size(); ++i) mask[i] = image.is_defined(i) ? 1.0F : 0.0F;
    return mask;
}

void write_parts(ExrStream& stream, std::span<const DecodedImage> images) {
    uint32_t columns = 0, rows = 0;
    for (const DecodedImage& image : images) {
        columns = std::max(columns, image.columns);
        rows = std::max(rows, image.rows);
    }
    std::vector<Imf::Header> headers;
    for (size_t i = 0; i < images.size(); ++i) {
        headers.push_back(header_of(images[i], window_of(columns, rows)));
        headers.back().setName("image" + std::to_string(i));
        headers.back().setType(Imf::SCANLINEIMAGE);
    }
    Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()));
    for (size_t i = 0; i < images.size(); ++i) {
        const std::vector<float> mask = mask_of(images[i]);
        Imf::OutputPart part(file, static_cast<int>(i));
        part.setFrameBuffer(frame_of(images[i], mask));
        part.writePixels(static_cast<int>(images[i].rows));
    }
}

}  // namespace

Result<Bytes> write_triples_exr(uint32_t columns, uint32_t rows, const std::vector<float>& values,
                                const std::array<const char*, 3>& channels) {
    ExrStream stream;
    try {
        const Imath::Box2i window = window_of(columns, rows);
        Imf::Header header(window, window);
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer frame;
        for (size_t k = 0; k < 3; ++k) {
            header.channels().insert(channels[k], Imf::Channel(Imf::FLOAT));
            frame.insert(channels[k], Imf::Slice(Imf::FLOAT, base_of(values.data() + k), 3 * sizeof(float),
                                                 3 * sizeof(float) * size_t{columns}));
        }
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writePixels(static_cast<int>(rows));
    } catch (const std::exception& failure) {
        return Error{Stage::kWrite, std::string("OpenEXR: ") + failure.what()};
    }
    return std::move(stream.bytes);
}

Result<Bytes> write_exr(std::span<const DecodedImage> images) {
    ExrStream stream;
    try {
        if (images.size() == 1) {
            const std::vector<float> mask = mask_of(images[0]);
            Imf::OutputFile file(stream, header_of(images[0], window_of(images[0].columns, images[0].rows)));
            file.setFrameBuffer(frame_of(images[0], mask));
            file.writePixels(static_cast<int>(images[0].rows));
        } else {
            write_parts(stream, images);
        }
    } catch (const std::exception& failure) {
        return Error{Stage::kWrite, std::string("OpenEXR: ") + failure.what()};
    }
    return std::move(stream.bytes);
}

}  // namespace gim

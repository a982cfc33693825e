// What other lossless coders make of images of uint16 numbers, for tools/rd/import_set.py. Evaluation only.
//
//   gim_rival_images SIDE < IMAGES      each image: SIDE x SIDE x 4 uint16, little-endian
//
// Prints a line for each: bytes of zstd -19, of PNG with 16 bits (the best of its filters, and of choosing one for each
// row), of EXR with PIZ and 32-bit whole numbers.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include "tools/exr_stream.h"

namespace gim {
namespace {

constexpr size_t kChannels = 4, kBytesPerPixel = 2 * kChannels, kFilters = 5;
constexpr size_t kPngFrame = 57;  // signature, header, end, and the frame of the data

using Numbers = std::vector<uint16_t>;

size_t zstd_size(const Numbers& image) {
    Bytes out(ZSTD_compressBound(2 * image.size()));
    return ZSTD_compress(out.data(), out.size(), image.data(), 2 * image.size(), 19);
}

uint8_t predicted(size_t filter, int left, int above, int corner) {
    switch (filter) {
        case 1:
            return static_cast<uint8_t>(left);
        case 2:
            return static_cast<uint8_t>(above);
        case 3:
            return static_cast<uint8_t>((left + above) / 2);
        case 4: {
            const int p = left + above - corner;
            const int a = std::abs(p - left), b = std::abs(p - above), c = std::abs(p - corner);
            return static_cast<uint8_t>(a <= b && a <= c ? left : b <= c ? above : corner);
        }
        default:
            return 0;
    }
}

Bytes filtered(const Bytes& row, const Bytes& above, size_t filter) {
    Bytes out = {static_cast<uint8_t>(filter)};
    for (size_t i = 0; i < row.size(); ++i) {
        const bool has_left = i >= kBytesPerPixel;
        const int left = has_left ? row[i - kBytesPerPixel] : 0, corner = has_left ? above[i - kBytesPerPixel] : 0;
        out.push_back(static_cast<uint8_t>(row[i] - predicted(filter, left, above[i], corner)));
    }
    return out;
}

int absolute_sum(const Bytes& row) {
    int sum = 0;
    for (const uint8_t b : row) sum += std::abs(static_cast<int8_t>(b));
    return sum;
}

size_t deflated_size(const Bytes& bytes) {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    Bytes out(size);
    compress2(out.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), 9);
    return size;
}

size_t png_size(const Numbers& image, size_t side) {
    std::array<Bytes, kFilters + 1> streams;  // the last one chooses a filter for each row, as libpng does
    Bytes above(side * kBytesPerPixel, 0);
    for (size_t r = 0; r < side; ++r) {
        Bytes row;
        for (size_t i = r * side * kChannels; i < (r + 1) * side * kChannels; ++i) {
            row.push_back(static_cast<uint8_t>(image[i] >> 8));
            row.push_back(static_cast<uint8_t>(image[i]));
        }
        Bytes best;
        for (size_t filter = 0; filter < kFilters; ++filter) {
            const Bytes out = filtered(row, above, filter);
            streams[filter].insert(streams[filter].end(), out.begin(), out.end());
            if (best.empty() || absolute_sum(out) < absolute_sum(best)) best = out;
        }
        streams[kFilters].insert(streams[kFilters].end(), best.begin(), best.end());
        above = row;
    }
    size_t least = SIZE_MAX;
    for (const Bytes& stream : streams) least = std::min(least, deflated_size(stream));
    return least + kPngFrame;
}

size_t exr_size(const Numbers& image, size_t side) {
    ExrStream stream;
    std::array<std::vector<uint32_t>, kChannels> planes;
    Imf::Header header(static_cast<int>(side), static_cast<int>(side));
    header.compression() = Imf::PIZ_COMPRESSION;
    Imf::FrameBuffer frame;
    constexpr const char* kNames[kChannels] = {"X", "Y", "Z", "mask"};
    for (size_t k = 0; k < kChannels; ++k) {
        for (size_t i = k; i < image.size(); i += kChannels) planes[k].push_back(image[i]);
        header.channels().insert(kNames[k], Imf::Channel(Imf::UINT));
        frame.insert(kNames[k], Imf::Slice(Imf::UINT, reinterpret_cast<char*>(planes[k].data()), 4, 4 * side));
    }
    {
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writePixels(static_cast<int>(side));
    }
    return stream.bytes.size();
}

}  // namespace
}  // namespace gim

int main(int argc, char** argv) {
    const size_t side = argc == 2 ? std::strtoul(argv[1], nullptr, 10) : 0;
    if (side < 2 || side > 4096) return 2;
    gim::Numbers image(side * side * gim::kChannels);
    while (std::fread(image.data(), 2, image.size(), stdin) == image.size())
        std::printf("%zu %zu %zu\n", gim::zstd_size(image), gim::png_size(image, side), gim::exr_size(image, side));
    return 0;
}

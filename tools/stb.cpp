#include "tools/stb.h"

#include "tools/little_endian.h"
#include "tools/texture_picture.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#include <stb_easy_font.h>
#include <stb_image.h>
#include <stb_image_write.h>
#pragma GCC diagnostic pop

namespace gim {

std::vector<uint8_t> png_bytes(const uint8_t* rgb, uint32_t width, uint32_t height) {
    std::vector<uint8_t> bytes;
    const auto keep = [](void* context, void* data, int size) {
        const auto* begin = static_cast<const uint8_t*>(data);
        static_cast<std::vector<uint8_t>*>(context)->assign(begin, begin + size);
    };
    const int stride = static_cast<int>(3 * width);
    if (stbi_write_png_to_func(keep, &bytes, static_cast<int>(width), static_cast<int>(height), 3, rgb, stride) == 0) {
        return {};
    }
    return bytes;
}

std::vector<uint8_t> png16_bytes(const uint16_t* rgb, uint32_t width, uint32_t height) {
    // Rows of big-endian samples, each as differences to the row above (filter 2).
    std::vector<uint8_t> rows;
    rows.reserve((size_t{6} * width + 1) * height);
    std::vector<uint8_t> above(size_t{6} * width, 0), row(above.size());
    for (uint32_t r = 0; r < height; ++r) {
        for (size_t i = 0; i < size_t{3} * width; ++i) {
            const uint16_t value = rgb[size_t{r} * width * 3 + i];
            row[2 * i] = static_cast<uint8_t>(value >> 8);
            row[2 * i + 1] = static_cast<uint8_t>(value);
        }
        rows.push_back(2);
        for (size_t i = 0; i < row.size(); ++i) rows.push_back(static_cast<uint8_t>(row[i] - above[i]));
        std::swap(row, above);
    }
    if (rows.size() > INT32_MAX) return {};
    int packed_size = 0;
    unsigned char* packed = stbi_zlib_compress(rows.data(), static_cast<int>(rows.size()), &packed_size, 8);
    if (!packed) return {};

    std::vector<uint8_t> bytes = {0x89, 'P', 'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A};
    const auto append_big_endian = [&](uint32_t value) {
        for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<uint8_t>(value >> shift));
    };
    const auto append_chunk = [&](const char* type, const std::vector<uint8_t>& data) {
        append_big_endian(static_cast<uint32_t>(data.size()));
        const size_t begin = bytes.size();
        bytes.insert(bytes.end(), type, type + 4);
        bytes.insert(bytes.end(), data.begin(), data.end());
        append_big_endian(stbiw__crc32(bytes.data() + begin, static_cast<int>(bytes.size() - begin)));
    };
    std::vector<uint8_t> header;
    for (const uint32_t size : {width, height}) {
        for (int shift = 24; shift >= 0; shift -= 8) header.push_back(static_cast<uint8_t>(size >> shift));
    }
    header.insert(header.end(), {16, 2, 0, 0, 0});  // bits, rgb, and the only methods there are
    append_chunk("IHDR", header);
    append_chunk("IDAT", {packed, packed + packed_size});
    append_chunk("IEND", {});
    STBIW_FREE(packed);
    return bytes;
}

uint64_t pixels_in_picture(std::span<const uint8_t> file) {
    int width = 0, height = 0, channels = 0;
    if (file.size() > INT32_MAX) return 0;
    if (stbi_info_from_memory(file.data(), static_cast<int>(file.size()), &width, &height, &channels) == 0) return 0;
    return static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
}

DecodedPicture decode_picture(std::span<const uint8_t> file) {
    constexpr uint64_t kMostPixels = uint64_t{1} << 28;
    DecodedPicture picture;
    const uint64_t pixel_count = pixels_in_picture(file);
    if (pixel_count == 0 || pixel_count > kMostPixels) return picture;
    const int size = static_cast<int>(file.size());
    int width = 0, height = 0, channels = 0;
    stbi_uc* pixels = stbi_load_from_memory(file.data(), size, &width, &height, &channels, 3);
    if (!pixels) return picture;
    picture.width = static_cast<uint32_t>(width);
    picture.height = static_cast<uint32_t>(height);
    picture.rgb.assign(pixels, pixels + size_t{picture.width} * picture.height * 3);
    stbi_image_free(pixels);
    return picture;
}

RgbaPicture decode_rgba(std::span<const uint8_t> file) {
    constexpr uint64_t kMostPixels = uint64_t{1} << 28;
    RgbaPicture picture;
    const uint64_t pixel_count = pixels_in_picture(file);
    if (pixel_count == 0 || pixel_count > kMostPixels) return picture;
    int width = 0, height = 0, channels = 0;
    stbi_uc* pixels = stbi_load_from_memory(file.data(), static_cast<int>(file.size()), &width, &height, &channels, 4);
    if (!pixels) return picture;
    picture.width = static_cast<uint32_t>(width);
    picture.height = static_cast<uint32_t>(height);
    picture.is_jpeg = file[0] == 0xFF;
    picture.pixels.assign(pixels, pixels + size_t{picture.width} * picture.height * 4);
    stbi_image_free(pixels);
    for (size_t i = 3; i < picture.pixels.size() && !picture.has_alpha; i += 4)
        picture.has_alpha = picture.pixels[i] != 255;
    return picture;
}

namespace {

void keep_bytes(void* context, void* data, int size) {
    const auto* begin = static_cast<const uint8_t*>(data);
    auto* bytes = static_cast<std::vector<uint8_t>*>(context);
    bytes->insert(bytes->end(), begin, begin + size);
}

}  // namespace

std::vector<uint8_t> encode_png(const std::vector<uint8_t>& pixels, uint32_t width, uint32_t height, int channels) {
    std::vector<uint8_t> bytes;
    const int columns = static_cast<int>(width);
    stbi_write_png_to_func(keep_bytes, &bytes, columns, static_cast<int>(height), channels, pixels.data(),
                           channels * columns);
    return bytes;
}

std::vector<uint8_t> encode_jpeg(const std::vector<uint8_t>& pixels, uint32_t width, uint32_t height) {
    constexpr int kQuality = 90;
    std::vector<uint8_t> bytes;
    stbi_write_jpg_to_func(keep_bytes, &bytes, static_cast<int>(width), static_cast<int>(height), 3, pixels.data(),
                           kQuality);
    return bytes;
}

std::vector<TextBox> text_boxes(const std::string& text) {
    constexpr size_t kVertexSize = 16;  // three floats and a colour
    constexpr size_t kBytesPerLetter = 300;
    std::vector<char> buffer(kBytesPerLetter * text.size() + 4 * kVertexSize);
    std::string copy = text;
    const int quads = stb_easy_font_print(0, 0, copy.data(), nullptr, buffer.data(), static_cast<int>(buffer.size()));
    std::vector<TextBox> boxes;
    for (int i = 0; i < quads; ++i) {
        const char* first = buffer.data() + static_cast<size_t>(i) * 4 * kVertexSize;
        const char* third = first + 2 * kVertexSize;
        boxes.push_back({static_cast<double>(load_f32(first)), static_cast<double>(load_f32(first + 4)),
                         static_cast<double>(load_f32(third)), static_cast<double>(load_f32(third + 4))});
    }
    return boxes;
}

}  // namespace gim

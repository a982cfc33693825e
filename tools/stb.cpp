#include "tools/stb.h"

#include "tools/little_endian.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb_easy_font.h>
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

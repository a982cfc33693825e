#include "tools/picture.h"

#include <algorithm>
#include <cmath>

#include "tools/stb.h"

namespace gim {
namespace {

constexpr uint32_t kCaptionHeight = 40;

void fill_box(Picture& picture, double left, double top, double right, double bottom, uint8_t grey) {
    const auto x1 = std::min(static_cast<uint32_t>(std::max(right, 0.0)), picture.width);
    const auto y1 = std::min(static_cast<uint32_t>(std::max(bottom, 0.0)), picture.height);
    for (auto y = static_cast<uint32_t>(std::max(top, 0.0)); y < y1; ++y) {
        for (auto x = static_cast<uint32_t>(std::max(left, 0.0)); x < x1; ++x) {
            std::fill_n(picture.rgb.begin() + static_cast<std::ptrdiff_t>(3 * (size_t{y} * picture.width + x)), 3,
                        grey);
        }
    }
}

void draw_caption(Picture& picture, const std::string& text, uint32_t left, uint32_t width, uint32_t top) {
    const std::vector<TextBox> boxes = text_boxes(text);
    double extent = 1;
    for (const TextBox& box : boxes) extent = std::max(extent, box.right);
    const double scale = std::clamp(std::floor(0.95 * width / extent), 1.0, 2.0);
    const double x = left + std::max(0.0, 0.5 * (width - scale * extent));
    const double y = top + 0.5 * kCaptionHeight - 4 * scale;
    for (const TextBox& box : boxes) {
        fill_box(picture, x + scale * box.left, y + scale * box.top, x + scale * box.right, y + scale * box.bottom, 40);
    }
}

}  // namespace

Picture place_side_by_side(std::span<const Panel> panels) {
    Picture all;
    for (const Panel& panel : panels) {
        all.width += panel.picture.width;
        all.height = std::max(all.height, panel.picture.height);
    }
    const uint32_t caption_top = all.height;
    all.height += kCaptionHeight;
    all.rgb.assign(size_t{3} * all.width * all.height, 255);
    uint32_t left = 0;
    for (const Panel& panel : panels) {
        const size_t row_bytes = size_t{3} * panel.picture.width;
        for (uint32_t row = 0; row < panel.picture.height; ++row) {
            std::copy_n(panel.picture.rgb.begin() + static_cast<std::ptrdiff_t>(row * row_bytes), row_bytes,
                        all.rgb.begin() + static_cast<std::ptrdiff_t>(3 * (size_t{row} * all.width + left)));
        }
        draw_caption(all, panel.caption, left, panel.picture.width, caption_top);
        left += panel.picture.width;
    }
    return all;
}

Picture place_below(const Picture& top, const Picture& bottom) {
    Picture all;
    all.width = std::max(top.width, bottom.width);
    all.height = top.height + bottom.height;
    all.rgb.assign(size_t{3} * all.width * all.height, 255);
    const auto copy = [&](const Picture& picture, uint32_t first_row) {
        const size_t row_bytes = size_t{3} * picture.width;
        for (uint32_t row = 0; row < picture.height; ++row) {
            std::copy_n(picture.rgb.begin() + static_cast<std::ptrdiff_t>(row * row_bytes), row_bytes,
                        all.rgb.begin() + static_cast<std::ptrdiff_t>(size_t{3} * (first_row + row) * all.width));
        }
    };
    copy(top, 0);
    copy(bottom, top.height);
    return all;
}

Result<Bytes> write_png(const Picture& picture) {
    Bytes bytes = png_bytes(picture.rgb.data(), picture.width, picture.height);
    if (bytes.empty()) return Error{Stage::kWrite, "the PNG library failed (out of memory?)"};
    return bytes;
}

}  // namespace gim

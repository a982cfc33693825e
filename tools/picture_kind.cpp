#include "tools/picture_kind.h"

namespace gim {

PictureKind picture_kind(std::span<const uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\x89PNG")) return {"PNG", "image/png", true};
    if (text.starts_with("\xFF\xD8\xFF")) return {"JPEG", "image/jpeg", true};
    if (text.starts_with("RIFF") && text.substr(0, 12).ends_with("WEBP")) return {"WebP", "image/webp"};
    if (text.starts_with("\xABKTX 20")) return {"KTX", "image/ktx2"};
    if (text.starts_with("\xABKTX")) return {"KTX", ""};
    if (text.starts_with("DDS ")) return {"DDS", "image/vnd-ms.dds"};
    if (text.size() > 12 && text.substr(4, 8) == "ftypavif") return {"AVIF", "image/avif"};
    return {};
}

}  // namespace gim

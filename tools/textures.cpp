#include "tools/textures.h"

#include <algorithm>
#include <filesystem>

#include "tools/file.h"
#include "tools/foreign_format.h"
#include "tools/stb.h"

namespace gim {

std::string Textures::path_of(std::string_view name) const {
    std::string clean(name);
    std::replace(clean.begin(), clean.end(), '\\', '/');
    return (std::filesystem::path(folder_) / clean).string();
}

// Only regular files: a mesh may name a device, which never ends.
bool Textures::exists(std::string_view name) const {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path_of(name), ignored);
}

Result<Bytes> Textures::read(std::string_view name) const {
    const std::string path = path_of(name);
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(path, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        return Error{Stage::kInput, "it is not a file"};
    return read_file(path);
}

uint32_t Textures::load(std::string_view name) {
    for (const Known& known : known_) {
        if (known.name == name) return known.index;
    }
    const Result<Bytes> file = read(name);
    uint32_t index = kNoTexture;
    if (file.ok()) {
        index = add(file.value(), std::string(name));
    } else {
        warnings.push_back("texture " + std::string(name) + ": " + file.error().message + "; it is left out");
    }
    known_.push_back({std::string(name), index});
    return index;
}

uint32_t Textures::add(std::span<const uint8_t> file, const std::string& name) {
    if (memory_) {
        constexpr uint64_t kBytesPerPixel = 6;  // once unpacked, once as a texture
        const Result<void> fits = memory_->take(pixels_in_picture(file), kBytesPerPixel, "its pixels");
        if (!fits.ok()) {
            warnings.push_back("texture " + name + ": " + fits.error().message + "; it is left out");
            return kNoTexture;
        }
    }
    DecodedPicture picture = decode_picture(file);
    if (picture.rgb.empty()) {
        warnings.push_back("texture " + name + ": not an image that gim can read; it is left out");
        return kNoTexture;
    }
    images.push_back({picture.width, picture.height, std::move(picture.rgb)});
    return static_cast<uint32_t>(images.size() - 1);
}

std::string Textures::read_text(std::string_view name) {
    const Result<Bytes> file = read(name);
    const std::string lost = "; its colours and textures are left out";
    if (!file.ok()) {
        warnings.push_back("material file " + std::string(name) + ": " + file.error().message + lost);
        return {};
    }
    const std::string_view text(reinterpret_cast<const char*>(file.value().data()), file.value().size());
    if (is_wide_text(text)) {
        warnings.push_back("material file " + std::string(name) + ": it is UTF-16 text; save it as UTF-8" + lost);
        return {};
    }
    return std::string(without_byte_order_mark(text));
}

}  // namespace gim

#include "tools/textures.h"

#include <algorithm>
#include <filesystem>

#include "tools/file.h"
#include "tools/stb.h"

namespace gim {

std::string Textures::path_of(std::string_view name) const {
    std::string clean(name);
    std::replace(clean.begin(), clean.end(), '\\', '/');
    return (std::filesystem::path(folder_) / clean).string();
}

uint32_t Textures::load(std::string_view name) {
    for (const Known& known : known_) {
        if (known.name == name) return known.index;
    }
    const Result<Bytes> file = read_file(path_of(name));
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
    const Result<Bytes> file = read_file(path_of(name));
    if (file.ok()) return {file.value().begin(), file.value().end()};
    warnings.push_back("material file " + std::string(name) + ": " + file.error().message +
                       "; its textures are left out");
    return {};
}

}  // namespace gim

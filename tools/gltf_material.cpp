#include "tools/gltf_material.h"

#include <algorithm>
#include <cmath>

#include "tools/gltf_uri.h"
#include "tools/picture_kind.h"

namespace gim::gltf {
namespace {

// Extensions that give a texture another image than its `source`.
constexpr std::array<const char*, 4> kImageExtensions = {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif",
                                                         "MSFT_texture_dds"};

// Rotates as the reference viewers do: counter-clockwise as an image is seen, whose v points down.
void apply_transform(const Json& transform, BaseColor& color) {
    std::vector<double> offset = numbers(transform, "offset", 2);
    std::vector<double> scale = numbers(transform, "scale", 2);
    const double rotation = real_number(transform, "rotation", 0);
    if (offset.empty()) offset = {0, 0};
    if (scale.empty()) scale = {1, 1};
    const double c = std::cos(rotation);
    const double s = std::sin(rotation);
    color.to_u = {c * scale[0], s * scale[1], offset[0]};
    color.to_v = {-s * scale[0], c * scale[1], offset[1]};
}

}  // namespace

void read_texture(const Json& info, BaseColor& color) {
    color.texture = whole_number(info, "index");
    color.texcoord_set = whole_number(info, "texCoord").value_or(0);
    const Json& transform = extension(info, "KHR_texture_transform");
    if (!transform.is_object()) return;
    color.texcoord_set = whole_number(transform, "texCoord").value_or(color.texcoord_set);
    apply_transform(transform, color);
}

uint32_t Pictures::load(uint64_t texture) {
    const auto known = textures_loaded_.find(texture);
    if (known != textures_loaded_.end()) return known->second;
    uint32_t loaded = Textures::kNoTexture;
    try {
        const Json& object = element(file_.root(), "textures", texture);
        const std::optional<uint64_t> source = whole_number(object, "source");
        const char* only = nullptr;
        for (const char* name : kImageExtensions) {
            if (extension(object, name).is_object()) only = name;
        }
        if (!source && only) throw Failure("its image is of the extension " + std::string(only) + ", which gim lacks");
        if (!source) throw Failure("it has no image");
        loaded = load_image(*source);
    } catch (const Failure& failure) {
        file_.context().warn("texture " + std::to_string(texture) + " of the glTF file: " + failure.what() +
                             "; it is left out");
    }
    textures_loaded_.emplace(texture, loaded);
    return loaded;
}

uint32_t Pictures::load_image(uint64_t image) {
    const auto known = images_loaded_.find(image);
    if (known != images_loaded_.end()) return known->second;
    uint32_t& index = images_loaded_[image] = Textures::kNoTexture;  // a failure is told once for an image
    const Json& object = element(file_.root(), "images", image);
    const std::optional<uint64_t> view = whole_number(object, "bufferView");
    const std::string uri = text(object, "uri");
    Bytes read;
    std::span<const uint8_t> bytes;
    if (view) {
        bytes = file_.view(*view);
    } else {
        try {
            read = read_uri(uri, file_.context().folder, file_.memory().left());
        } catch (const Failure& failure) {
            throw Failure("image " + std::to_string(image) + ", " + shown_uri(uri) + ": " + failure.what());
        }
        bytes = read;
    }
    const PictureKind kind = picture_kind(bytes);
    if (!kind.name.empty() && !kind.is_read)
        throw Failure("image " + std::to_string(image) + " is " + std::string(kind.name) + ", which gim does not read");
    index = file_.context().textures->add(bytes, std::to_string(image) + " of the glTF file");
    return index;
}

BaseColor base_color(const Json& root, const Json& primitive) {
    BaseColor color;
    const std::optional<uint64_t> index = whole_number(primitive, "material");
    if (!index) return color;
    const Json& material = element(root, "materials", *index);
    const Json& look = member(material, "pbrMetallicRoughness");
    const Json& older = extension(material, "KHR_materials_pbrSpecularGlossiness");
    const bool is_older = older.is_object() && !look.is_object();
    const std::vector<double> factor =
        is_older ? numbers(older, "diffuseFactor", 4) : numbers(look, "baseColorFactor", 4);
    if (!factor.empty()) std::copy_n(factor.begin(), 3, color.factor.begin());
    const Json& info = is_older ? member(older, "diffuseTexture") : member(look, "baseColorTexture");
    if (info.is_object()) read_texture(info, color);
    return color;
}

float to_srgb(double linear) {
    const double x = linear >= 0 ? std::min(linear, 1.0) : 0;
    return static_cast<float>(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

}  // namespace gim::gltf

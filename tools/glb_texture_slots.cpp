#include "tools/glb_texture_slots.h"

#include <algorithm>

#include "tools/gltf_uri.h"

namespace gim::gltf {
namespace {

const std::vector<double> kNoWeights;

// Textures that hold colours as sRGB.
bool is_srgb(const std::string& path) {
    for (const char* name : {"/baseColorTexture", "/emissiveTexture", "/sheenColorTexture", "/specularColorTexture",
                             "/diffuseTexture", "/specularGlossinessTexture", "/diffuseTransmissionColorTexture"}) {
        if (path.ends_with(name)) return true;
    }
    return false;
}

bool is_normal(const std::string& path) {
    return path.ends_with("/normalTexture") || path.ends_with("/clearcoatNormalTexture");
}

// Calls f(path, texture info) for the textures of a material, wherever they are in it.
template <class F>
void each_texture(const Json& value, const std::string& path, const F& f) {
    if (!value.is_object()) return;
    for (const auto& [name, child] : value.items()) {
        if (name == "extras") continue;
        const std::string inner = path + "/" + name;
        if (name.ends_with("Texture") && !member(child, "index").is_null()) {
            f(inner, child);
        } else {
            each_texture(child, inner, f);
        }
    }
}

TextureWrap wrap_of(const Json& sampler, const char* key) {
    const uint64_t told = whole_number(sampler, key).value_or(0);
    if (told == static_cast<uint64_t>(TextureWrap::kClamp)) return TextureWrap::kClamp;
    return told == static_cast<uint64_t>(TextureWrap::kMirror) ? TextureWrap::kMirror : TextureWrap::kRepeat;
}

}  // namespace

std::string TextureSource::signature() const {
    if (!picture) return "white";
    return Json({image, use.texcoord_set, use.to_u, use.to_v, static_cast<uint32_t>(wrap_u),
                 static_cast<uint32_t>(wrap_v), scale})
        .dump();
}

std::string TextureSlot::signature() const {
    std::string text = std::string(srgb ? "s" : "") + (normal ? "n" : "") + (with_colors ? "c" : "");
    for (const auto& source : sources) text += "|" + (source ? source->signature() : "");
    return text;
}

const Json& TextureSlots::material_of(const Json& primitive) const {
    static const Json plain = Json::object();
    const std::optional<uint64_t> index = whole_number(primitive, "material");
    return index ? element(file_.root(), "materials", *index) : plain;
}

const RgbaPicture& TextureSlots::picture(uint64_t index) {
    const auto [found, is_new] = pictures_.try_emplace(index);
    Picture& known = found->second;
    if (is_new) {
        const Json& image = element(file_.root(), "images", index);
        try {
            Bytes read;
            const std::optional<uint64_t> view = whole_number(image, "bufferView");
            if (!view) read = read_uri(text(image, "uri"), file_.context().folder, file_.memory().left());
            const std::span<const uint8_t> bytes = view ? file_.view(*view) : read;
            known.rgba = decode_rgba(bytes);
            take(file_.memory(), known.rgba.pixels.size(), 1, "the pixels of its pictures");
            if (known.rgba.pixels.empty()) known.problem = "it is no picture that gim can read";
        } catch (const Failure& failure) {
            known.problem = failure.what();
        }
    }
    if (!known.problem.empty()) throw Failure("its image " + std::to_string(index) + ": " + known.problem);
    return known.rgba;
}

TextureSource TextureSlots::source_of(const Json& info) {
    TextureSource source;
    read_texture(info, source.use);
    const Json& texture = element(file_.root(), "textures", *source.use.texture);
    const std::optional<uint64_t> image = whole_number(texture, "source");
    if (!image) throw Failure("its texture " + std::to_string(*source.use.texture) + " has no PNG or JPEG picture");
    source.image = *image;
    source.picture = &picture(*image);
    source.scale = real_number(info, "scale", 1);
    if (const std::optional<uint64_t> sampler = whole_number(texture, "sampler")) {
        source.wrap_u = wrap_of(element(file_.root(), "samplers", *sampler), "wrapS");
        source.wrap_v = wrap_of(element(file_.root(), "samplers", *sampler), "wrapT");
    }
    return source;
}

bool TextureSlots::has_colors(const Json& object) {
    Primitive primitive(file_, draco_, object, kNoWeights);
    if (!primitive.has("COLOR_0")) return false;
    const MorphedColumn colors = primitive.attribute("COLOR_0", 3);
    for (uint64_t row = 0; row < colors.base.count; ++row) {
        for (size_t k = 0; k < colors.base.width; ++k)
            if (colors.at(row, k) != 1) return true;
    }
    return false;
}

std::map<std::string, TextureSlot> TextureSlots::of(const Json& mesh) {
    std::map<std::string, TextureSlot> slots;
    const Json& primitives = member(mesh, "primitives");
    bool is_opaque = true;
    for (size_t p = 0; p < primitives.size(); ++p) {
        const Json& material = material_of(primitives[p]);
        is_opaque = is_opaque && text(material, "alphaMode", "OPAQUE") == "OPAQUE";
        const auto slot = [&](const std::string& path) -> TextureSlot& {
            TextureSlot& found = slots[path];
            found.srgb = is_srgb(path);
            found.normal = is_normal(path);
            found.sources.resize(primitives.size());
            return found;
        };
        each_texture(material, "", [&](const std::string& path, const Json& info) {
            if (path.ends_with("/anisotropyTexture")) throw Failure("gim cannot draw an anisotropyTexture anew");
            const TextureSource source = source_of(info);
            if (member(member(primitives[p], "attributes"), source.texcoord_set()).is_null())
                throw Failure("a texture wants " + source.texcoord_set() + ", which is not there");
            slot(path).sources[p] = source;
        });
        if (!has_colors(primitives[p])) continue;
        if (!extension(material, "KHR_materials_pbrSpecularGlossiness").is_null())
            throw Failure("it has colours of vertices with KHR_materials_pbrSpecularGlossiness");
        TextureSlot& base = slot(kBaseColor);
        base.with_colors = true;
        if (!base.sources[p]) base.sources[p] = TextureSource{};
    }
    if (slots.contains(kBaseColor)) slots[kBaseColor].is_opaque = is_opaque;
    return slots;
}

WantedArrays TextureSlots::wanted(const Json& primitive) {
    WantedArrays wanted;
    wanted.texcoords = has_colors(primitive);
    each_texture(material_of(primitive), "", [&](const std::string& path, const Json&) {
        wanted.texcoords = true;
        wanted.tangents = wanted.tangents || is_normal(path);
    });
    return wanted;
}

}  // namespace gim::gltf

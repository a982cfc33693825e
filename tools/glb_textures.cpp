#include "tools/glb_textures.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tools/glb_frames.h"

namespace gim::gltf {
namespace {

constexpr size_t kMostImages = 1024;
const std::vector<double> kNoWeights;

double mean(const MorphedColumn& column, size_t k, const std::array<uint32_t, 3>& rows,
            const std::array<double, 3>& weights) {
    double sum = 0;
    for (size_t i = 0; i < 3; ++i) sum += weights[i] * column.at(rows[i], k);
    return sum;
}

uint8_t byte_of(double value) { return static_cast<uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0))); }

}  // namespace

// What a slot shows at points of one primitive.
struct TextureBaker::SlotReader {
    SlotReader(const TextureSlot& of, const TextureSource& from, Primitive& primitive, bool with_colors)
        : slot(of), source(from) {
        if (source.picture) texcoords = primitive.attribute(source.texcoord_set(), 2);
        if (with_colors) colors = primitive.attribute("COLOR_0", 3);
        if (slot.normal) frames.emplace(primitive, source.texcoord_set());
    }

    std::array<double, 2> texcoord(const std::array<uint32_t, 3>& rows, const std::array<double, 3>& weights) const {
        const double u = mean(texcoords, 0, rows, weights), v = mean(texcoords, 1, rows, weights);
        const BaseColor& use = source.use;
        return {use.to_u[0] * u + use.to_u[1] * v + use.to_u[2], use.to_v[0] * u + use.to_v[1] * v + use.to_v[2]};
    }

    // Red, green, blue and alpha, 0..1; linear light if the slot is sRGB.
    std::array<double, 4> value(const std::array<uint32_t, 3>& rows, const std::array<double, 3>& weights) const {
        std::array<double, 4> value = {1, 1, 1, 1};
        if (source.picture) {
            const auto [u, v] = texcoord(rows, weights);
            value = sample(*source.picture, u, v, source.wrap_u, source.wrap_v, slot.srgb);
        }
        for (size_t k = 0; colors && k < colors->base.width && k < 4; ++k)
            value[k] *= std::clamp(mean(*colors, k, rows, weights), 0.0, 1.0);
        return value;
    }

    // The normal that the picture gives, in object space.
    Eigen::Vector3d normal(const std::array<uint32_t, 3>& rows, const std::array<double, 3>& weights) const {
        const std::array<double, 4> rgb = value(rows, weights);
        const Eigen::Vector3d local((2 * rgb[0] - 1) * source.scale, (2 * rgb[1] - 1) * source.scale, 2 * rgb[2] - 1);
        return frames->axes(rows, weights) * local.normalized();
    }

    const TextureSlot& slot;
    const TextureSource& source;
    MorphedColumn texcoords;
    std::optional<MorphedColumn> colors;
    std::optional<InputFrames> frames;
};

namespace {

// A direction as a normal texture says it, in the frame of the decoded surface.
std::array<uint8_t, 3> packed_normal(const Eigen::Matrix3d& axes, const Eigen::Vector3d& direction) {
    Eigen::Vector3d local =
        std::abs(axes.determinant()) < 1e-3 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(axes.inverse() * direction);
    local.z() = std::max(local.z(), 0.0);  // a renderer shows nothing that looks inwards
    local = local.norm() > 1e-6 ? local.normalized() : Eigen::Vector3d::UnitZ();
    std::array<uint8_t, 3> bytes{};
    for (size_t k = 0; k < 3; ++k) bytes[k] = byte_of((1 + local[static_cast<int>(k)]) / 2);
    return bytes;
}

// How many pixels of a texture a triangle shows. Without a picture, what it takes to show colours of vertices.
double pixels_of(const TextureSource& source, const std::array<std::array<double, 2>, 3>& uv) {
    constexpr double kForColors = 2;
    if (!source.picture) return kForColors;
    const double area = (uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) - (uv[2][0] - uv[0][0]) * (uv[1][1] - uv[0][1]);
    return std::abs(area) / 2 * source.picture->width * source.picture->height;
}

bool keeps_alpha(const TextureSlot& slot) {
    if (slot.normal || slot.is_opaque) return false;
    return slot.with_colors || std::any_of(slot.sources.begin(), slot.sources.end(), [](const auto& source) {
               return source && source->picture && source->picture->has_alpha;
           });
}

// JPEG where all pictures were.
bool may_be_jpeg(const TextureSlot& slot) {
    if (slot.normal || keeps_alpha(slot)) return false;
    return std::all_of(slot.sources.begin(), slot.sources.end(),
                       [](const auto& source) { return !source || (source->picture && source->picture->is_jpeg); });
}

}  // namespace

size_t TextureBaker::draw(const TextureSlot& slot, const Json& mesh, const MeshSurface& surface, MeshAtlas& atlas) {
    std::vector<std::unique_ptr<Primitive>> primitives;
    std::vector<std::unique_ptr<SlotReader>> readers(slot.sources.size());
    for (size_t p = 0; p < readers.size(); ++p) {
        const Json& object = mesh["primitives"][p];
        primitives.push_back(std::make_unique<Primitive>(file_, draco_, object, kNoWeights));
        if (!slot.sources[p]) continue;
        const bool with_colors = slot.with_colors && slots_.has_colors(object);
        readers[p] = std::make_unique<SlotReader>(slot, *slot.sources[p], *primitives[p], with_colors);
    }
    const auto rows_of = [&](uint32_t triangle) {
        std::array<uint32_t, 3> rows = surface.mesh.triangles[triangle];
        for (uint32_t& row : rows) row -= surface.first_vertex[surface.mesh.labels[triangle]];
        return rows;
    };
    double pixels = 0;
    for (uint32_t t = 0; t < surface.mesh.triangles.size(); ++t) {
        const SlotReader* reader = readers[surface.mesh.labels[t]].get();
        if (!reader) continue;
        std::array<std::array<double, 2>, 3> uv{};
        for (size_t k = 0; k < 3 && reader->source.picture; ++k) {
            std::array<double, 3> corner{};
            corner[k] = 1;
            uv[k] = reader->texcoord(rows_of(t), corner);
        }
        pixels += pixels_of(reader->source, uv);
    }
    const AtlasSize size = atlas.size_for(pixels, [&](uint32_t primitive) { return readers[primitive] != nullptr; });
    const size_t channels = keeps_alpha(slot) ? 4 : 3, count = size_t{size.width} * size.height;
    take(file_.memory(), count, channels, "the texels of its new textures");
    std::vector<uint8_t> bytes(channels * count, 255);
    std::vector<bool> has_value(count, false);
    for (const MeshAtlas::Texel& texel : atlas.texels(size)) {
        const SlotReader* reader = readers[surface.mesh.labels[texel.at.triangle]].get();
        if (!reader) continue;
        const std::array<uint32_t, 3> rows = rows_of(texel.at.triangle);
        uint8_t* out = &bytes[channels * texel.index];
        has_value[texel.index] = true;
        if (slot.normal) {
            const FrameAt at = frame_at(atlas.arrays(), texel.triangle, texel.weights);
            const auto packed = packed_normal(at.axes, reader->normal(rows, texel.at.weights));
            std::copy(packed.begin(), packed.end(), out);
            continue;
        }
        const std::array<double, 4> value = reader->value(rows, texel.at.weights);
        for (size_t k = 0; k < channels; ++k) out[k] = slot.srgb && k < 3 ? srgb_byte(value[k]) : byte_of(value[k]);
    }
    fill_gaps(bytes, channels, has_value, size);
    return add_texture(bytes, size, channels, may_be_jpeg(slot));
}

size_t TextureBaker::add_texture(const std::vector<uint8_t>& pixels, const AtlasSize& size, size_t channels,
                                 bool as_jpeg) {
    if (!sampler_) {
        constexpr int kClampToEdge = 33071, kLinear = 9729, kLinearMipmapLinear = 9987;
        Json& samplers = document_.root["samplers"];
        sampler_ = samplers.size();
        samplers.push_back({{"magFilter", kLinear},
                            {"minFilter", kLinearMipmapLinear},
                            {"wrapS", kClampToEdge},
                            {"wrapT", kClampToEdge}});
    }
    Bytes file = as_jpeg ? encode_jpeg(pixels, size.width, size.height)
                         : encode_png(pixels, size.width, size.height, static_cast<int>(channels));
    if (file.empty()) throw Failure("there is not enough memory for its new textures");
    const size_t view = document_.add_view(std::move(file), GlbDocument::Place::kPicture);
    const size_t image =
        document_.add(List::kImages, {{"bufferView", view}, {"mimeType", as_jpeg ? "image/jpeg" : "image/png"}});
    return document_.add(List::kTextures, {{"source", image}, {"sampler", *sampler_}});
}

// A copy of the primitive's material that shows the new textures.
size_t TextureBaker::material_with(const Json& primitive, size_t index, const std::map<std::string, TextureSlot>& slots,
                                   const std::map<std::string, size_t>& textures) {
    const std::optional<uint64_t> own = whole_number(primitive, "material");
    Json material = own ? element(file_.root(), "materials", *own) : Json::object();
    for (const auto& [path, slot] : slots) {
        if (!slot.sources[index]) continue;
        Json& info = material[Json::json_pointer(path)];
        info["index"] = textures.at(path);
        info.erase("texCoord");
        if (slot.normal) info.erase("scale");
        if (!info.contains("extensions")) continue;
        info["extensions"].erase("KHR_texture_transform");
        if (info["extensions"].empty()) info.erase("extensions");
    }
    return document_.add(List::kMaterials, std::move(material));
}

std::vector<std::optional<size_t>> TextureBaker::bake(const Json& mesh, const MeshSurface& surface,
                                                      const GimGeometry& geometry) {
    const Json& primitives = member(mesh, "primitives");
    std::vector<std::optional<size_t>> materials(primitives.size());
    const std::map<std::string, TextureSlot> slots = slots_.of(mesh);
    if (slots.empty()) return materials;
    if (geometry.images.size() > kMostImages) throw Failure("it has too many parts for one atlas of textures");
    MeshAtlas atlas(surface, geometry, threads_);
    std::map<std::string, size_t> textures, drawn;  // by path; by signature
    for (const auto& [path, slot] : slots) {
        const std::string signature = slot.signature();
        if (!drawn.contains(signature)) drawn[signature] = draw(slot, mesh, surface, atlas);
        textures[path] = drawn[signature];
    }
    std::map<std::string, size_t> made;  // by material, and by whether it shows colours of vertices
    for (size_t p = 0; p < primitives.size(); ++p) {
        const bool is_textured = std::any_of(slots.begin(), slots.end(),
                                             [&](const auto& slot) { return slot.second.sources[p].has_value(); });
        if (!is_textured) continue;
        const std::string key =
            member(primitives[p], "material").dump() + (slots_.has_colors(primitives[p]) ? "c" : "");
        if (!made.contains(key)) made[key] = material_with(primitives[p], p, slots, textures);
        materials[p] = made[key];
    }
    return materials;
}

}  // namespace gim::gltf

// glTF 2.0 binary: one buffer, one mesh, node and material per image; planes as PNG textures in the buffer.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "tools/glb_file.h"
#include "tools/plane_write.h"
#include "tools/stb.h"
#include "tools/surface_write.h"
#include "tools/tangent_space.h"

namespace gim {
namespace {

using nlohmann::json;

// Numbers of the glTF specification.
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;

// Collects arrays of 4-byte values, so that every view is aligned as the specification asks.
struct Buffer {
    Bytes bytes;
    json views = json::array();
    json accessors = json::array();
    json textures = json::array();  // texture i is image i
    json pictures = json::array();

    // Adds a texture: a PNG of rgb pixels, as many as the plane has. Returns its index.
    size_t add_texture(const std::vector<uint8_t>& rgb, const ImagePlane& size) {
        const Bytes png = png_bytes(rgb.data(), size.columns, size.rows);
        views.push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", png.size()}});
        bytes.insert(bytes.end(), png.begin(), png.end());
        while (bytes.size() % 4 != 0) bytes.push_back(0);
        pictures.push_back({{"bufferView", views.size() - 1}, {"mimeType", "image/png"}});
        textures.push_back({{"source", pictures.size() - 1}, {"sampler", 0}});
        return textures.size() - 1;
    }

    template <class T>
    size_t add(const std::vector<T>& values, int width, const char* type, int component, int target) {
        views.push_back({{"buffer", 0},
                         {"byteOffset", bytes.size()},
                         {"byteLength", values.size() * sizeof(T)},
                         {"target", target}});
        accessors.push_back({{"bufferView", views.size() - 1},
                             {"componentType", component},
                             {"count", values.size() / static_cast<size_t>(width)},
                             {"type", type}});
        const auto* begin = reinterpret_cast<const uint8_t*>(values.data());
        bytes.insert(bytes.end(), begin, begin + values.size() * sizeof(T));
        return accessors.size() - 1;
    }
};

// POSITION must state its bounds.
void add_bounds(json& accessor, const std::vector<float>& positions) {
    std::array<double, 3> low = {positions[0], positions[1], positions[2]};
    std::array<double, 3> high = low;
    for (size_t i = 0; i < positions.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], static_cast<double>(positions[i]));
        high[i % 3] = std::max(high[i % 3], static_cast<double>(positions[i]));
    }
    accessor["min"] = low;
    accessor["max"] = high;
}

// Returns the texture coordinates for a texture of the plane's size. Without a plane they stay unchanged.
std::vector<float> texcoords_for(const DecodedImage& image, const GridMesh& grid, const ImagePlane& plane) {
    std::vector<float> uv = at_samples(grid, image.grid_texcoords, 2);
    for (size_t i = 0; i + 1 < uv.size(); i += 2) {
        uv[i] = texture_coordinate(uv[i], plane.columns);
        uv[i + 1] = texture_coordinate(uv[i + 1], plane.rows);
    }
    return uv;
}

json plain_material() {
    return {{"doubleSided", true}, {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.7}}}};
}

// Adds the textures of an image's planes to the material, and texture coordinates and tangents to the attributes.
void add_planes(const DecodedImage& image, const GridMesh& grid, Buffer& buffer, json& attributes, json& material) {
    const ImagePlane& first = image.colors.is_there() ? image.colors : image.normal_map;
    attributes["TEXCOORD_0"] = buffer.add(texcoords_for(image, grid, first), 2, "VEC2", kFloat, kArrayBuffer);
    if (image.colors.is_there()) {
        material["pbrMetallicRoughness"]["baseColorTexture"] = {
            {"index", buffer.add_texture(color_pixels(image.colors), image.colors)}};
    }
    if (image.normal_map.is_there()) {
        const std::vector<float> tangents = grid_tangents(image);
        attributes["TANGENT"] = buffer.add(at_samples(grid, tangents, 4), 4, "VEC4", kFloat, kArrayBuffer);
        const std::vector<uint8_t> map = tangent_space_map(image, tangents, image.normal_map);
        material["normalTexture"] = {{"index", buffer.add_texture(map, image.normal_map)}};
        if (image.normal_map.columns != first.columns || image.normal_map.rows != first.rows) {
            attributes["TEXCOORD_1"] =
                buffer.add(texcoords_for(image, grid, image.normal_map), 2, "VEC2", kFloat, kArrayBuffer);
            material["normalTexture"]["texCoord"] = 1;
        }
    }
}

}  // namespace

Result<Bytes> write_glb(std::span<const DecodedImage> images, bool fused) {
    Buffer buffer;
    json meshes = json::array();
    json nodes = json::array();
    json roots = json::array();
    json materials = json::array();
    for (size_t i = 0; i < images.size(); ++i) {
        const DecodedImage& image = images[i];
        const GridMesh grid = fused ? GridMesh{} : grid_mesh(image);
        const std::vector<float> positions = fused ? image.positions : at_samples(grid, image.grid, 3);
        json attributes;
        json material = plain_material();
        attributes["POSITION"] = buffer.add(positions, 3, "VEC3", kFloat, kArrayBuffer);
        add_bounds(buffer.accessors.back(), positions);
        std::vector<float> normals = fused ? image.normals : at_samples(grid, image.shading_normals(), 3);
        replace_zero_normals(normals);
        attributes["NORMAL"] = buffer.add(normals, 3, "VEC3", kFloat, kArrayBuffer);
        if (!fused) add_planes(image, grid, buffer, attributes, material);
        // Images without textures share one material.
        auto same = std::find(materials.begin(), materials.end(), material);
        if (same == materials.end()) {
            materials.push_back(material);
            same = materials.end() - 1;
        }
        const size_t indices =
            buffer.add(fused ? image.triangles : grid.triangles, 1, "SCALAR", kUnsignedInt, kElementArrayBuffer);
        const std::string name = "image" + std::to_string(i);
        meshes.push_back({{"name", name},
                          {"primitives", json::array({{{"attributes", attributes},
                                                       {"indices", indices},
                                                       {"material", same - materials.begin()},
                                                       {"mode", 4}}})}});
        nodes.push_back({{"name", name}, {"mesh", i}});
        if (image.is_relative()) nodes.back()["translation"] = image.origin;
        roots.push_back(i);
    }
    while (buffer.bytes.size() % 4 != 0) buffer.bytes.push_back(0);

    json document;
    document["asset"] = {{"version", "2.0"}, {"generator", "gim"}};
    document["scene"] = 0;
    document["scenes"] = json::array({{{"nodes", roots}}});
    document["nodes"] = nodes;
    document["meshes"] = meshes;
    document["materials"] = materials;
    if (!buffer.textures.empty()) {
        document["textures"] = buffer.textures;
        document["images"] = buffer.pictures;
        constexpr int kClampToEdge = 33071, kLinear = 9729, kLinearMipmapLinear = 9987;
        document["samplers"] = json::array({{{"magFilter", kLinear},
                                             {"minFilter", kLinearMipmapLinear},
                                             {"wrapS", kClampToEdge},
                                             {"wrapT", kClampToEdge}}});
    }
    document["accessors"] = buffer.accessors;
    document["bufferViews"] = buffer.views;
    document["buffers"] = json::array({{{"byteLength", buffer.bytes.size()}}});
    return glb_bytes(document.dump(), std::move(buffer.bytes));
}

}  // namespace gim

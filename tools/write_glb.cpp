// glTF 2.0 binary: one buffer, one mesh and node per image.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/little_endian.h"
#include "tools/surface_write.h"

namespace gim {
namespace {

using nlohmann::json;

// Numbers of the glTF specification.
constexpr uint32_t kMagic = 0x46546C67;
constexpr uint32_t kJsonChunk = 0x4E4F534A;
constexpr uint32_t kBinaryChunk = 0x004E4942;
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;

// Collects arrays of 4-byte values, so that every view is aligned as the specification asks.
struct Buffer {
    Bytes bytes;
    json views = json::array();
    json accessors = json::array();

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

// Normals must have length 1; where the surface has none any direction will do.
std::vector<float> without_zeros(std::vector<float> normals) {
    for (size_t i = 0; i + 2 < normals.size(); i += 3) {
        if (normals[i] == 0 && normals[i + 1] == 0 && normals[i + 2] == 0) normals[i + 2] = 1;
    }
    return normals;
}

std::vector<float> grid_texcoords(uint32_t side) {
    std::vector<float> uv;
    uv.reserve(size_t{2} * side * side);
    const auto last = static_cast<float>(side - 1);
    for (uint32_t row = 0; row < side; ++row) {
        for (uint32_t column = 0; column < side; ++column) {
            uv.push_back(static_cast<float>(column) / last);
            uv.push_back(static_cast<float>(row) / last);
        }
    }
    return uv;
}

void pad(Bytes& bytes, uint8_t with) {
    while (bytes.size() % 4 != 0) bytes.push_back(with);
}

void append_chunk(Bytes& out, uint32_t type, const Bytes& bytes) {
    append(out, static_cast<uint32_t>(bytes.size()));
    append(out, type);
    out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace

Result<Bytes> write_glb(std::span<const DecodedImage> images, bool fused) {
    Buffer buffer;
    json meshes = json::array();
    json nodes = json::array();
    json roots = json::array();
    for (size_t i = 0; i < images.size(); ++i) {
        const DecodedImage& image = images[i];
        const std::vector<float>& positions = fused ? image.positions : image.grid;
        json attributes;
        attributes["POSITION"] = buffer.add(positions, 3, "VEC3", kFloat, kArrayBuffer);
        add_bounds(buffer.accessors.back(), positions);
        attributes["NORMAL"] =
            buffer.add(without_zeros(fused ? image.normals : image.grid_normals), 3, "VEC3", kFloat, kArrayBuffer);
        if (!fused) {
            attributes["TEXCOORD_0"] = buffer.add(grid_texcoords(image.side), 2, "VEC2", kFloat, kArrayBuffer);
        }
        const size_t indices =
            buffer.add(fused ? image.triangles : image.grid_triangles, 1, "SCALAR", kUnsignedInt, kElementArrayBuffer);
        const std::string name = "image" + std::to_string(i);
        meshes.push_back(
            {{"name", name},
             {"primitives",
              json::array({{{"attributes", attributes}, {"indices", indices}, {"material", 0}, {"mode", 4}}})}});
        nodes.push_back({{"name", name}, {"mesh", i}});
        roots.push_back(i);
    }
    pad(buffer.bytes, 0);

    json document;
    document["asset"] = {{"version", "2.0"}, {"generator", "gim"}};
    document["scene"] = 0;
    document["scenes"] = json::array({{{"nodes", roots}}});
    document["nodes"] = nodes;
    document["meshes"] = meshes;
    document["materials"] = json::array(
        {{{"doubleSided", true}, {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.7}}}}});
    document["accessors"] = buffer.accessors;
    document["bufferViews"] = buffer.views;
    document["buffers"] = json::array({{{"byteLength", buffer.bytes.size()}}});
    const std::string text = document.dump();
    Bytes header(text.begin(), text.end());
    pad(header, ' ');

    const uint64_t size = uint64_t{12} + 8 + header.size() + 8 + buffer.bytes.size();
    if (size > UINT32_MAX) return Error{Stage::kWrite, "GLB files end at 4 GB; choose PLY or a coarser --level"};
    Bytes out;
    out.reserve(size);
    append(out, kMagic);
    append(out, uint32_t{2});
    append(out, static_cast<uint32_t>(size));
    append_chunk(out, kJsonChunk, header);
    append_chunk(out, kBinaryChunk, buffer.bytes);
    return out;
}

}  // namespace gim

// Builds glTF files for the tests of the reader, one buffer each.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/mesh_read.h"

namespace gim::test {

using Json = nlohmann::json;

inline bool says(const std::string& text, const std::string& word) { return text.find(word) != std::string::npos; }

inline std::string base64(const std::string& data) {
    static const char* const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < data.size(); i += 3) {
        uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k) {
            word = word << 8 | (i + k < data.size() ? static_cast<uint8_t>(data[i + k]) : 0U);
        }
        for (size_t k = 0; k < 4; ++k) out += i + k <= data.size() ? kDigits[word >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

// The numbers of the specification.
template <class T>
int component_type() {
    if (std::is_same_v<T, int8_t>) return 5120;
    if (std::is_same_v<T, uint8_t>) return 5121;
    if (std::is_same_v<T, int16_t>) return 5122;
    if (std::is_same_v<T, uint16_t>) return 5123;
    return std::is_same_v<T, uint32_t> ? 5125 : 5126;
}

class GltfBuilder {
  public:
    Json root = {{"asset", {{"version", "2.0"}}},
                 {"scenes", Json::array({{{"nodes", Json::array({0})}}})},
                 {"nodes", Json::array({{{"mesh", 0}}})},
                 {"meshes", Json::array({{{"primitives", Json::array({Json::object()})}}})}};

    Json& primitive() { return root["meshes"][0]["primitives"][0]; }
    Json& node() { return root["nodes"][0]; }

    // Each returns the index of what it adds.
    template <class T>
    size_t view(const std::vector<T>& values) {
        const size_t offset = (bytes_.size() + 3) / 4 * 4;
        bytes_.resize(offset + values.size() * sizeof(T));
        if (!values.empty()) std::memcpy(bytes_.data() + offset, values.data(), values.size() * sizeof(T));
        return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", values.size() * sizeof(T)}});
    }
    template <class T>
    size_t accessor(const std::string& type, const std::vector<T>& values) {
        const size_t width = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<size_t>(type[3] - '0');
        return add("accessors", {{"bufferView", view(values)},
                                 {"componentType", component_type<T>()},
                                 {"count", values.size() / width},
                                 {"type", type}});
    }
    size_t add(const std::string& list, const Json& object) {
        if (!root.contains(list)) root[list] = Json::array();
        root[list].push_back(object);
        return root[list].size() - 1;
    }
    void attribute(const std::string& name, size_t accessor) { primitive()["attributes"][name] = accessor; }
    void use_extension(const std::string& name, bool required = true) {
        root["extensionsUsed"].push_back(name);
        if (required) root["extensionsRequired"].push_back(name);
    }
    // A tetrahedron with corners at the origin and at 1 on every axis.
    void add_tetrahedron() {
        attribute("POSITION", accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}));
        primitive()["indices"] = accessor<uint16_t>("SCALAR", {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2});
    }

    const std::string& bytes() const { return bytes_; }
    // The JSON as text, with the bytes inside.
    std::string text() const {
        Json whole = root;
        if (!whole.contains("buffers")) {
            whole["buffers"] = Json::array(
                {{{"byteLength", bytes_.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes_)}}});
        }
        return whole.dump();
    }

  private:
    std::string bytes_;
};

inline GltfBuilder tetrahedron() {
    GltfBuilder file;
    file.add_tetrahedron();
    return file;
}

// What a reader makes of a file.
struct GltfRead {
    bool ok = false;
    TriangleMesh mesh;
    std::string message;                // of the error
    std::vector<std::string> warnings;  // also as one text
    std::string all_warnings;
};

inline GltfRead read_gltf_text(const std::string& content, const std::string& folder = "",
                               uint64_t max_memory = uint64_t{1} << 30) {
    Textures textures(folder);
    ReadContext context{folder, &textures, MemoryBudget(max_memory)};
    textures.limit_memory(&context.memory);
    const std::vector<uint8_t> bytes(content.begin(), content.end());  // own allocation: sanitizers see its end
    Result<TriangleMesh> mesh = read_mesh(bytes, MeshFormat::kGltf, context);
    GltfRead read;
    read.ok = mesh.ok();
    if (mesh.ok()) read.mesh = std::move(mesh.value());
    if (!mesh.ok()) read.message = mesh.error().message;
    read.warnings = context.warnings;
    for (const std::string& warning : read.warnings) read.all_warnings += warning + "\n";
    return read;
}

inline GltfRead read_gltf_file(const GltfBuilder& file) { return read_gltf_text(file.text()); }

}  // namespace gim::test

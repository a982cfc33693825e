// The development models (GIM_MODELS_DIR). If the folder is missing, tests that need it are visibly skipped.
#pragma once

#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "gim/encoder.h"

namespace gim {

// Reads the positions and triangles of a binary little-endian PLY as the models have it: scalars in the vertex element,
// lists with a uchar count in the face element. Returns nothing if there is no such file.
inline std::optional<TriangleMesh> read_model(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    const auto size_of = [](const std::string& type) -> size_t {
        if (type == "double") return 8;
        if (type == "char" || type == "uchar") return 1;
        if (type == "short" || type == "ushort") return 2;
        return 4;
    };
    size_t vertex_count = 0, face_count = 0, vertex_size = 0;
    bool in_vertex = false;
    std::vector<size_t> face_lists;
    for (std::string line; std::getline(file, line) && line != "end_header";) {
        std::istringstream words(line);
        std::string word, name, type;
        words >> word >> name;
        if (word == "element") {
            in_vertex = name == "vertex";
            words >> (in_vertex ? vertex_count : face_count);
        } else if (word == "property" && name == "list") {
            words >> type >> type;
            face_lists.push_back(size_of(type));
        } else if (word == "property" && in_vertex) {
            vertex_size += size_of(name);
        }
    }
    TriangleMesh mesh;
    std::vector<char> record(vertex_size);
    for (size_t v = 0; v < vertex_count; ++v) {
        file.read(record.data(), static_cast<std::streamsize>(vertex_size));
        float xyz[3];
        std::memcpy(xyz, record.data(), sizeof xyz);
        mesh.positions.push_back({xyz[0], xyz[1], xyz[2]});
    }
    for (size_t f = 0; f < face_count; ++f) {
        for (size_t list = 0; list < face_lists.size(); ++list) {
            std::vector<char> values(face_lists[list] * static_cast<uint8_t>(file.get()));
            file.read(values.data(), static_cast<std::streamsize>(values.size()));
            if (list > 0 || values.size() < 12) continue;
            std::array<uint32_t, 3> triangle;
            std::memcpy(triangle.data(), values.data(), sizeof triangle);
            mesh.triangles.push_back(triangle);
        }
    }
    return file ? std::optional(mesh) : std::nullopt;
}

inline std::optional<TriangleMesh> load_model(const std::string& name) {
    return read_model(std::string(GIM_MODELS_DIR) + "/" + name);
}

}  // namespace gim

// Shared by the fuzz targets of the mesh readers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "tools/mesh_read.h"

namespace gim::fuzz {

inline constexpr uint64_t kMaxMemory = uint64_t{1} << 28;

// Stops the fuzzer if a mesh breaks what a reader promises.
inline void check(const Result<TriangleMesh>& read) {
    if (!read.ok()) {
        if (read.error().message.empty()) __builtin_trap();
        return;
    }
    const TriangleMesh& mesh = read.value();
    if (mesh.triangles.empty()) __builtin_trap();
    for (const auto& t : mesh.triangles) {
        if (*std::max_element(t.begin(), t.end()) >= mesh.positions.size()) __builtin_trap();
    }
    const Appearance& look = mesh.appearance;
    const size_t count = mesh.triangles.size();
    for (const size_t size : {look.corner_colors.size(), look.corner_texcoords.size(), look.triangle_texture.size()}) {
        if (size != 0 && size != count) __builtin_trap();
    }
    for (const uint32_t t : look.triangle_texture) {
        if (t != UINT32_MAX && t >= look.textures.size()) __builtin_trap();
    }
    const Shading& shading = mesh.shading;
    if (!shading.empty() && shading.corners.size() != count) __builtin_trap();
    for (const auto& corners : shading.corners) {
        for (const uint32_t n : corners) {
            if (n != Shading::kFlat && n >= shading.normals.size()) __builtin_trap();
        }
    }
    for (const auto& corners : look.corner_colors) {
        for (const auto& color : corners) {
            for (const float c : color) {
                if (!(c >= 0 && c <= 1)) __builtin_trap();
            }
        }
    }
}

// Reads the bytes as this format, as a shape, and with colours and normals. There are no files beside it.
inline void read_as(MeshFormat format, const uint8_t* data, size_t size) {
    for (const bool colors : {false, true}) {
        const std::string nowhere = "/nonexistent";
        ReadContext context;
        context.folder = nowhere;
        context.memory = MemoryBudget(kMaxMemory);
        Textures textures(nowhere);
        textures.limit_memory(&context.memory);
        if (colors) context.textures = &textures;
        context.shading = colors;
        check(read_mesh({data, size}, format, context));
    }
    (void)detect_format({data, size}, "");
}

}  // namespace gim::fuzz

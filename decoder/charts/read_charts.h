// The calls of the C interface for files of charts.
#pragma once

#include <cstddef>
#include <span>

#include "format/container.h"
#include "gim/decoder.h"

namespace gim {

struct Memory {
    void* bytes = nullptr;
    size_t size = 0;
};

Status chart_level_info(const Header& header, std::span<const uint8_t> file, const ContainerLimits& limits,
                        uint32_t level, gim_level_info* info);

Status count_chart_paths(const Header& header, std::span<const uint8_t> file, const ContainerLimits& limits,
                         uint32_t level, uint32_t* path_count);

// What gim_decode_mesh and gim_decode_grid give.
struct SurfaceArrays {
    float* positions = nullptr;
    float* normals = nullptr;  // may be nullptr, as all below
    float* texcoords = nullptr;
    uint32_t* triangles = nullptr;
};
Status decode_chart_mesh(const Header& header, std::span<const uint8_t> file, const ContainerLimits& limits,
                         uint32_t level, const SurfaceArrays& out, const Memory& scratch);
Status decode_chart_grid(const Header& header, std::span<const uint8_t> file, const ContainerLimits& limits,
                         uint32_t level, const SurfaceArrays& out, const Memory& scratch);

}  // namespace gim

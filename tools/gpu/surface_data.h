// A decoded image as the shaders want it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gim/decoder.h"
#include "gim/encoder.h"
#include "gim/refine.h"
#include "tools/gpu/shader_types.h"

namespace gim {

struct SurfaceData {
    uint32_t width = 0, height = 0;          // samples
    std::vector<float> positions;            // of gim_decode_positions, x y z
    uint32_t map_width = 0, map_height = 0;  // texels of the normal map
    std::vector<int8_t> normals;             // x y z 0 each, 127 is 1
    uint32_t slot = 0;                       // as in ShaderDomain
    // In texels of the map: from one tile to the next, and from one sample to the next; columns, rows.
    std::array<double, 2> slot_texels{}, interval_texels{};
};

// Decodes an image for a domain that was opened at this level. The normal map is the file's plane of normals, or else the
// normals of level 0. Images of GIM_LAYOUT_MCGIM have no domain.
Result<SurfaceData> read_surface_data(const gim_info& info, std::span<const uint8_t> bytes, uint32_t image,
                                      uint32_t level);

// The same for a domain whose vertices the caller has, as one with details. positions, normals: three floats a vertex. The
// normal map is as fine as the samples. is_tiles: whether the layout is GIM_LAYOUT_TILES.
SurfaceData surface_data_of(const gim_domain* domain, const gim_domain_info& shape, bool is_tiles,
                            std::span<const float> positions, std::span<const float> normals);

// Several images in shared buffers: positions one after the other, normal maps below each other in one texture.
struct SurfaceStore {
    std::vector<ShaderDomain> domains;
    std::vector<float> positions;
    uint32_t map_width = 0, map_height = 0;
    std::vector<int8_t> normals;
};
SurfaceStore join_surfaces(std::span<const SurfaceData> surfaces);

}  // namespace gim

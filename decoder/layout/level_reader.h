// What the decoder asks of a layout: one struct of functions for each. layouts.h has the table, domains.h that of layouts
// that can be refined.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "decoder/layout/plane_level.h"
#include "decoder/layout/tile_glue.h"
#include "format/container.h"
#include "gim/decoder.h"

namespace gim {

// One level of one image of a file. The image exists; the level may not.
struct LevelRequest {
    const Header& header;
    std::span<const uint8_t> file;
    const ContainerLimits& limits;
    uint32_t image = 0, level = 0;
    uint32_t finer = 0;  // of a domain: how often its intervals are halved beyond the level
};

// Memory of the caller.
struct Memory {
    void* bytes = nullptr;
    size_t size = 0;
};

// Checks that scratch is there, is aligned and has `needed` bytes.
inline Status check_scratch(const Memory& scratch, uint64_t needed) {
    if (!scratch.bytes || reinterpret_cast<uintptr_t>(scratch.bytes) % 16 != 0) return Status::kBadArgument;
    return scratch.size < needed ? Status::kScratchTooSmall : Status::kOk;
}

// What gim_decode_mesh and gim_decode_grid write.
struct SurfaceArrays {
    float* positions = nullptr;
    float* normals = nullptr;  // may be nullptr, as all below
    float* texcoords = nullptr;
    uint32_t* triangles = nullptr;
    // Of a mesh: not nullptr if vertices shall be split at sharp edges. Receives their number if there are such edges.
    uint32_t* hard_vertices = nullptr;
};

struct LevelReader {
    Status (*level_info)(const LevelRequest& request, gim_level_info* info);
    Status (*mesh)(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch);
    Status (*grid)(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch);
    // class_of, path_count: as in gim_read_seams.
    Status (*seams)(const LevelRequest& request, uint32_t* class_of, uint32_t* path_count);

    // Opens a level of the plane that `chunk` at `offset` holds. request.level: of the plane.
    Status (*open_plane)(const LevelRequest& request, const Chunk& chunk, uint64_t offset, PlaneLevel* plane);
    // Bytes of scratch that decode_plane needs.
    uint64_t (*plane_scratch_size)(const LevelRequest& request, const PlaneLevel& plane);
    // Writes plane.width * plane.height triples as they are stored. Those of one surface point are equal.
    Status (*decode_plane)(const LevelRequest& request, const PlaneLevel& plane, void* scratch, float* values);
};

// The tiles of a level, to be refined (gim/refine.h). Not every layout has some.
struct DomainReader {
    // scratch_size: of read_glue.
    Status (*shape)(const LevelRequest& request, DomainShape* shape, uint64_t* scratch_size);
    // Fills all arrays of the glue but is_anti. scratch is large enough.
    Status (*read_glue)(const LevelRequest& request, const DomainShape& shape, void* scratch, TileGlue* glue);
};

// Checks the chunk of a plane and fills plane->chunk and plane->prefix.
Status read_plane_chunk(const LevelRequest& request, const Chunk& chunk, uint64_t offset, PlaneLevel* plane);

// Decodes a plane that is one pyramid.
Status decode_pyramid_plane(const PlaneLevel& plane, const PyramidWorkspace& ws, float* values);

}  // namespace gim

// The calls of the C interface for tiles, as layout/level_reader.h describes them.
#pragma once

#include "decoder/layout/level_reader.h"

namespace gim {

Status tile_level_info(const LevelRequest& request, gim_level_info* info);
Status decode_tile_mesh(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch);
Status decode_tile_grid(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch);
Status read_tile_seams(const LevelRequest& request, uint32_t* class_of, uint32_t* path_count);

Status tile_domain_shape(const LevelRequest& request, DomainShape* shape, uint64_t* scratch_size);
Status read_tile_glue(const LevelRequest& request, const DomainShape& shape, void* scratch, TileGlue* glue);

Status open_tile_plane(const LevelRequest& request, const Chunk& chunk, uint64_t offset, PlaneLevel* plane);
uint64_t tile_plane_scratch_size(const LevelRequest& request, const PlaneLevel& plane);
Status decode_tile_plane(const LevelRequest& request, const PlaneLevel& plane, void* scratch, float* values);

}  // namespace gim

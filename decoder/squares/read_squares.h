// The calls of the C interface for files of squares.
#pragma once

#include "decoder/layout/level_reader.h"

namespace gim {

Status square_level_info(const LevelRequest& request, gim_level_info* info);
Status decode_square_mesh(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch);
Status decode_square_grid(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch);
Status read_square_seams(const LevelRequest& request, uint32_t* class_of, uint32_t* path_count);

// The tiles are the cells of the coarsest level.
Status square_domain_shape(const LevelRequest& request, DomainShape* shape, uint64_t* scratch_size);
Status read_square_glue(const LevelRequest& request, const DomainShape& shape, void* scratch, TileGlue* glue);

Status open_square_plane(const LevelRequest& request, const Chunk& chunk, uint64_t offset, PlaneLevel* plane);
uint64_t square_plane_scratch_size(const LevelRequest& request, const PlaneLevel& plane);
Status decode_square_plane(const LevelRequest& request, const PlaneLevel& plane, void* scratch, float* values);

}  // namespace gim

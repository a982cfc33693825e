// The calls of the C interface for files that hold an imported image.
#pragma once

#include "decoder/layout/level_reader.h"
#include "decoder/raster/raster_decoder.h"

namespace gim {

Status raster_level_info(const LevelRequest& request, gim_level_info* info);
Status decode_raster_mesh(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch);
Status decode_raster_grid(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch);
// class_of must be nullptr. The image has no paths.
Status read_raster_seams(const LevelRequest& request, uint32_t* class_of, uint32_t* path_count);

// Such files have no planes.
Status open_raster_plane(const LevelRequest& request, const Chunk& chunk, uint64_t offset, PlaneLevel* plane);
uint64_t raster_plane_scratch_size(const LevelRequest& request, const PlaneLevel& plane);
Status decode_raster_plane(const LevelRequest& request, const PlaneLevel& plane, void* scratch, float* values);

// The samples themselves: gim_read_raster_info, gim_read_raster_channel, gim_decode_raster.
Status raster_info(const LevelRequest& request, gim_raster_info* info);
Status raster_channel(const LevelRequest& request, uint32_t index, gim_raster_channel* channel);
Status decode_raster_values(const LevelRequest& request, int32_t* values, uint8_t* mask, const Memory& scratch);

}  // namespace gim

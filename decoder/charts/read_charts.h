// The calls of the C interface for files of charts.
#pragma once

#include "decoder/layout/level_reader.h"

namespace gim {

Status chart_level_info(const LevelRequest& request, gim_level_info* info);
Status decode_chart_mesh(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch);
Status decode_chart_grid(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch);
// Charts have no ring: class_of must be nullptr.
Status read_chart_seams(const LevelRequest& request, uint32_t* class_of, uint32_t* path_count);

Status open_chart_plane(const LevelRequest& request, const Chunk& chunk, uint64_t offset, PlaneLevel* plane);
uint64_t chart_plane_scratch_size(const LevelRequest& request, const PlaneLevel& plane);
// Makes no samples equal: the encoder fills planes beyond the charts' borders, and no sample belongs to two of them.
Status decode_chart_plane(const LevelRequest& request, const PlaneLevel& plane, void* scratch, float* values);

}  // namespace gim

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
PlaneWorkspace lay_out_chart_plane(const PlaneLevel& plane, Arena* arena);
// Changes nothing: the encoder fills planes beyond the charts' borders, and no sample belongs to two of them.
void close_chart_plane(const PlaneLevel& plane, const PlaneWorkspace& ws, float* values);

}  // namespace gim

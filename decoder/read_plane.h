// What the layouts share when they open an attribute plane.
#pragma once

#include "decoder/level_reader.h"

namespace gim {

// Checks the chunk and fills plane->chunk and plane->prefix.
Status read_plane_chunk(const LevelRequest& request, const Chunk& chunk, uint64_t offset, PlaneLevel* plane);

}  // namespace gim

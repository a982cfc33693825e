#include "decoder/layout/level_reader.h"

namespace gim {

Status read_plane_chunk(const LevelRequest& request, const Chunk& chunk, uint64_t offset, PlaneLevel* plane) {
    std::span<const uint8_t> payload;
    if (Status s = read_payload(request.file, chunk, offset, &payload); s != Status::kOk) return s;
    plane->prefix = offset + chunk.size;
    return parse_plane(payload, request.header, request.image, request.limits, &plane->chunk);
}

}  // namespace gim

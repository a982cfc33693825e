#include "decoder/layout/level_reader.h"

#include <algorithm>
#include <new>

namespace gim {

Status read_plane_chunk(const LevelRequest& request, const Chunk& chunk, uint64_t offset, PlaneLevel* plane) {
    std::span<const uint8_t> payload;
    if (Status s = read_payload(request.file, chunk, offset, &payload); s != Status::kOk) return s;
    plane->prefix = offset + chunk.size;
    return parse_plane(payload, request.header, request.image, request.limits, &plane->chunk);
}

Status decode_pyramid_plane(const PlaneLevel& plane, const PyramidWorkspace& ws, float* values) {
    new (ws.models) BandModels(CoefficientKind::kPlanes);
    PyramidDecoder decoder(false, plane.shape, ws);
    if (Status s = decode_stream(decoder, ws, plane.chunk.stream, plane.shape.level); s != Status::kOk) return s;
    const size_t count = size_t{plane.width} * plane.height * 3;
    std::copy_n(to_units(false, ws.images[0], count), count, values);
    return Status::kOk;
}

}  // namespace gim

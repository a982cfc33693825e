// Attribute planes of the C interface: normals and colours on grids of their own.  spec/gim-format.md, "Planes".
#include <algorithm>
#include <new>

#include "decoder/layout/level_reader.h"
#include "decoder/layouts.h"
#include "decoder/pyramid/vector3.h"
#include "decoder/reopen.h"
#include "format/plane_code.h"
#include "gim/decoder.h"

namespace gim {
namespace {

static_assert(GIM_PLANE_NORMALS == 0 && GIM_PLANE_COLORS == 1);

uint64_t plane_scratch_size(const LevelReader& reader, const PlaneLevel& plane) {
    Arena arena(nullptr);
    (void)reader.lay_out_plane(plane, &arena);
    return arena.used();
}

Status open_plane(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t kind, uint32_t level,
                  const LevelReader** reader, PlaneLevel* plane) {
    Header header;
    if (Status s = reopen(info, bytes, size, &header); s != Status::kOk) return s;
    if (image >= header.image_count() || kind >= kPlaneKinds) return Status::kBadArgument;
    Chunk chunk;
    uint64_t offset = 0;
    if (!find_chunk(header, plane_type(kind), &chunk, &offset)) return Status::kNoSuchPlane;
    const ContainerLimits limits = limits_of(&info->limits);
    const LevelRequest request = {header, {static_cast<const uint8_t*>(bytes), size}, limits, image, level};
    *reader = &reader_of(header.layout);
    return (*reader)->open_plane(request, chunk, offset, plane);
}

void finish_color(float* c) {
    from_luma(c);
    for (int k = 0; k < 3; ++k) c[k] = std::min(std::max(c[k], 0.0f), 255.0f) / 255.0f;
}

Status decode_plane(const LevelReader& reader, const PlaneLevel& plane, uint32_t kind, const PlaneWorkspace& ws,
                    float* values) {
    PyramidDecoder<Irreversible97> decoder(plane.shape, ws.pyramid);
    new (ws.pyramid.models) BandModels(CoefficientKind::kPlanes);
    if (Status s = decode_stream(decoder, ws.pyramid, plane.chunk.stream, plane.shape.level); s != Status::kOk)
        return s;
    const size_t count = size_t{plane.width} * plane.height * 3;
    const float* samples = to_units<float>(ws.pyramid.images[0], count);
    std::copy_n(samples, count, values);
    reader.close_plane(plane, ws, values);
    for (size_t i = 0; i < count; i += 3) kind == GIM_PLANE_NORMALS ? normalize(values + i) : finish_color(values + i);
    return Status::kOk;
}

gim_status code(Status status) { return static_cast<gim_status>(status); }

}  // namespace

}  // namespace gim

using namespace gim;

gim_status gim_read_plane_info(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t kind,
                               uint32_t level, gim_plane_info* plane_info) {
    if (!plane_info) return GIM_BAD_ARGUMENT;
    PlaneLevel plane;
    const LevelReader* reader = nullptr;
    if (Status s = open_plane(info, bytes, size, image, kind, level, &reader, &plane); s != Status::kOk) return code(s);
    *plane_info = {};
    plane_info->width = plane.width;
    plane_info->height = plane.height;
    plane_info->coarsest_level = plane.coarsest;
    plane_info->quantizer = plane.chunk.quantizer;
    plane_info->stream_size = plane.chunk.stream.size();
    plane_info->prefix_size = plane.prefix;
    plane_info->scratch_size = plane_scratch_size(*reader, plane);
    return GIM_OK;
}

gim_status gim_decode_plane(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t kind,
                            uint32_t level, float* values, void* scratch, size_t scratch_size) {
    if (!values) return GIM_BAD_ARGUMENT;
    PlaneLevel plane;
    const LevelReader* reader = nullptr;
    if (Status s = open_plane(info, bytes, size, image, kind, level, &reader, &plane); s != Status::kOk) return code(s);
    if (Status s = check_scratch({scratch, scratch_size}, plane_scratch_size(*reader, plane)); s != Status::kOk)
        return code(s);
    Arena arena(scratch);
    const PlaneWorkspace ws = reader->lay_out_plane(plane, &arena);
    return code(decode_plane(*reader, plane, kind, ws, values));
}

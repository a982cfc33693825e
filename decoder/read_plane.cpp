// Attribute planes of the C interface: normals and colours on grids of their own.  spec/gim-format.md, "Planes".
#include <algorithm>

#include "decoder/reopen.h"
#include "decoder/squares/square_decoder.h"
#include "decoder/vector3.h"
#include "format/chart_table.h"
#include "format/plane_code.h"
#include "gim/decoder.h"

namespace gim {
namespace {

static_assert(GIM_PLANE_NORMALS == 0 && GIM_PLANE_COLORS == 1);

// One level of one image's plane, ready to be decoded.
struct PlaneLevel {
    PlaneChunk chunk;
    PyramidShape shape;
    bool has_ring = false;  // squares, whose ring is closed
    SeamTable seams;
    uint32_t width = 0, height = 0, coarsest = 0;
    uint64_t prefix = 0;
};

PlaneWorkspace lay_out(const PlaneLevel& plane, Arena* arena) {
    if (plane.has_ring) return lay_out_plane(plane.width, arena);
    PlaneWorkspace ws;
    lay_out_coder(plane.width, arena, &ws.pyramid);
    lay_out_planes(plane.width, plane.height, arena, &ws.pyramid);
    return ws;
}

uint64_t plane_scratch_size(const PlaneLevel& plane) {
    Arena arena(nullptr);
    (void)lay_out(plane, &arena);
    return arena.used();
}

Status open_plane(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t kind, uint32_t level,
                  PlaneLevel* out) {
    const std::span<const uint8_t> file = {static_cast<const uint8_t*>(bytes), size};
    Header header;
    if (Status s = reopen(info, bytes, size, &header); s != Status::kOk) return s;
    if (image >= header.image_count() || kind >= kPlaneKinds) return Status::kBadArgument;
    Chunk chunk;
    uint64_t offset = 0;
    if (!find_chunk(header, plane_type(kind), &chunk, &offset)) return Status::kNoSuchPlane;
    out->has_ring = header.layout == FileLayout::kSquares;
    if (out->has_ring) {
        if (Status s = read_seams(header, file, image, &out->seams); s != Status::kOk) return s;
    }
    std::span<const uint8_t> payload;
    if (Status s = read_payload(file, chunk, offset, &payload); s != Status::kOk) return s;
    if (Status s = parse_plane(payload, header, image, limits_of(&info->limits), &out->chunk); s != Status::kOk)
        return s;
    out->prefix = offset + chunk.size;
    const uint32_t exponent = out->chunk.side_exponents[image];
    if (!out->has_ring) {
        const auto width = static_cast<uint32_t>(chart_plane_side(header.width, exponent)),
                   height = static_cast<uint32_t>(chart_plane_side(header.height, exponent));
        out->coarsest = halvings(width, height);
        if (level > out->coarsest) return Status::kNoSuchLevel;
        out->width = halved(width, level);
        out->height = halved(height, level);
        out->shape = {width, height, out->coarsest, level, {out->chunk.quantizer}, 0, false};
        return Status::kOk;
    }

    // The ring's classes exist on grids at least as fine as the seams' own.
    const uint32_t side = out->chunk.side(image);
    const uint32_t least = std::max(3u, out->seams.node_side);
    if (side < least) return Status::kMalformed;
    while (((side - 1) >> (out->coarsest + 1)) + 1 >= least) ++out->coarsest;
    if (level > out->coarsest) return Status::kNoSuchLevel;
    out->width = out->height = ((side - 1) >> level) + 1;
    out->shape = square_shape(exponent, level, {out->chunk.quantizer}, 0);
    return Status::kOk;
}

void finish_color(float* c) {
    from_luma(c);
    for (int k = 0; k < 3; ++k) c[k] = std::min(std::max(c[k], 0.0f), 255.0f) / 255.0f;
}

Status decode_plane(const PlaneLevel& plane, uint32_t kind, const PlaneWorkspace& ws, float* values) {
    PyramidDecoder<Irreversible97> decoder(plane.shape, ws.pyramid);
    new (ws.pyramid.models) BandModels(CoefficientKind::kPlanes);
    if (Status s = decode_stream(decoder, ws.pyramid, plane.chunk.stream, plane.shape.level); s != Status::kOk)
        return s;
    const size_t count = size_t{plane.width} * plane.height * 3;
    const float* samples = to_units<float>(ws.pyramid.images[0], count);
    std::copy_n(samples, count, values);
    if (plane.has_ring) {
        ring_classes(plane.seams, plane.width, {ws.class_of, ring_length(plane.width)});
        average_classes(plane.width, ws.class_of, ring_class_count(plane.seams, plane.width), values, ws.fuse);
    }
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
    if (Status s = open_plane(info, bytes, size, image, kind, level, &plane); s != Status::kOk) return code(s);
    *plane_info = {};
    plane_info->width = plane.width;
    plane_info->height = plane.height;
    plane_info->coarsest_level = plane.coarsest;
    plane_info->quantizer = plane.chunk.quantizer;
    plane_info->stream_size = plane.chunk.stream.size();
    plane_info->prefix_size = plane.prefix;
    plane_info->scratch_size = plane_scratch_size(plane);
    return GIM_OK;
}

gim_status gim_decode_plane(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t kind,
                            uint32_t level, float* values, void* scratch, size_t scratch_size) {
    if (!values) return GIM_BAD_ARGUMENT;
    PlaneLevel plane;
    if (Status s = open_plane(info, bytes, size, image, kind, level, &plane); s != Status::kOk) return code(s);
    if (!scratch || reinterpret_cast<uintptr_t>(scratch) % 16 != 0) return GIM_BAD_ARGUMENT;
    if (scratch_size < plane_scratch_size(plane)) return GIM_SCRATCH_TOO_SMALL;
    Arena arena(scratch);
    const PlaneWorkspace ws = lay_out(plane, &arena);
    return code(decode_plane(plane, kind, ws, values));
}

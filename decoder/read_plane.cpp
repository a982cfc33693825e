// Attribute planes of the C interface: normals and colours on grids of their own.  spec/gim-format.md, "Planes".
#include <algorithm>

#include "decoder/layout/level_reader.h"
#include "decoder/pyramid/vector3.h"
#include "decoder/with_image.h"
#include "format/plane_code.h"
#include "gim/decoder.h"

namespace gim {
namespace {

static_assert(GIM_PLANE_NORMALS == 0 && GIM_PLANE_COLORS == 1);

// Calls f(reader, request, plane) for a level of a plane that is there, with the functions of the file's layout.
template <class F>
gim_status with_plane(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t kind,
                      uint32_t level, const F& f) {
    return with_image(info, bytes, size, image, level, [&](const LevelReader& reader, const LevelRequest& request) {
        if (kind >= kPlaneKinds) return Status::kBadArgument;
        Chunk chunk;
        uint64_t offset = 0;
        if (!find_chunk(request.header, plane_type(kind), &chunk, &offset)) return Status::kNoSuchPlane;
        PlaneLevel plane;
        if (Status s = reader.open_plane(request, chunk, offset, &plane); s != Status::kOk) return s;
        return f(reader, request, plane);
    });
}

void finish_color(float* c) {
    from_luma(c);
    for (int k = 0; k < 3; ++k) c[k] = std::min(std::max(c[k], 0.0f), 255.0f) / 255.0f;
}

}  // namespace

}  // namespace gim

using namespace gim;

gim_status gim_read_plane_info(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t kind,
                               uint32_t level, gim_plane_info* plane_info) {
    if (!plane_info) return GIM_BAD_ARGUMENT;
    const auto describe = [&](const LevelReader& reader, const LevelRequest& request, const PlaneLevel& plane) {
        *plane_info = {};
        plane_info->width = plane.width;
        plane_info->height = plane.height;
        plane_info->coarsest_level = plane.coarsest;
        plane_info->quantizer = plane.chunk.quantizer;
        plane_info->stream_size = plane.chunk.stream.size();
        plane_info->prefix_size = plane.prefix;
        plane_info->scratch_size = reader.plane_scratch_size(request, plane);
        return Status::kOk;
    };
    return with_plane(info, bytes, size, image, kind, level, describe);
}

gim_status gim_decode_plane(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t kind,
                            uint32_t level, float* values, void* scratch, size_t scratch_size) {
    if (!values) return GIM_BAD_ARGUMENT;
    const auto decode = [&](const LevelReader& reader, const LevelRequest& request, const PlaneLevel& plane) {
        const uint64_t needed = reader.plane_scratch_size(request, plane);
        if (Status s = check_scratch({scratch, scratch_size}, needed); s != Status::kOk) return s;
        if (Status s = reader.decode_plane(request, plane, scratch, values); s != Status::kOk) return s;
        const size_t count = size_t{plane.width} * plane.height * 3;
        for (size_t i = 0; i < count; i += 3)
            kind == GIM_PLANE_NORMALS ? normalize(values + i) : finish_color(values + i);
        return Status::kOk;
    };
    return with_plane(info, bytes, size, image, kind, level, decode);
}

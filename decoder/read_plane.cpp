// Attribute planes of the C interface: normals and colours on grids of their own.  spec/gim-format.md, "Planes".
#include <algorithm>

#include "decoder/layout/level_reader.h"
#include "decoder/pyramid/vector3.h"
#include "decoder/with_image.h"
#include "format/plane_code.h"
#include "gim/decoder.h"

namespace gim {
namespace {

static_assert(GIM_PLANE_NORMALS == 0 && GIM_PLANE_COLORS == 1 && GIM_PLANE_DISPLACEMENTS == 2);

// Calls f(reader, request, plane) for a level of a plane that is there, with the functions of the file's layout.
template <class F>
gim_status with_plane(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t kind,
                      uint32_t level, const F& f) {
    return with_image(info, bytes, size, image, [&](const LevelReader& reader, LevelRequest request) {
        request.level = level;
        PlaneLevel plane;
        if (Status s = open_plane(reader, request, kind, &plane); s != Status::kOk) return s;
        return f(reader, request, plane);
    });
}

void finish_color(float* c) {
    from_luma(c);
    for (int k = 0; k < 3; ++k) c[k] = std::min(std::max(c[k], 0.0f), 255.0f) / 255.0f;
}

// Turns `count` triples of samples into values.
void finish(uint32_t kind, float step, float* values, size_t count) {
    for (size_t i = 0; i < 3 * count; i += 3) {
        if (kind == GIM_PLANE_NORMALS) normalize(values + i);
        if (kind == GIM_PLANE_COLORS) finish_color(values + i);
        if (kind == GIM_PLANE_DISPLACEMENTS) {
            for (size_t k = 0; k < 3; ++k) values[i + k] = step * values[i + k];
        }
    }
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
        finish(kind, request.header.step, values, size_t{plane.width} * plane.height);
        return Status::kOk;
    };
    return with_plane(info, bytes, size, image, kind, level, decode);
}

// How functions of the C interface reach the layout of a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "decoder/layout/level_reader.h"
#include "decoder/layouts.h"
#include "decoder/reopen.h"
#include "gim/decoder.h"

namespace gim {

inline gim_status code(Status status) { return static_cast<gim_status>(status); }

inline std::span<const uint8_t> span_of(const void* bytes, size_t size) {
    return {static_cast<const uint8_t*>(bytes), size};
}

// Calls f(reader, request) for an image of a file, with the functions of the file's layout. request.level is 0.
template <class F>
gim_status with_image(const gim_info* info, const void* bytes, size_t size, uint32_t image, const F& f) {
    Header header;
    if (Status s = reopen(info, bytes, size, &header); s != Status::kOk) return code(s);
    if (image >= header.image_count()) return code(Status::kBadArgument);
    const ContainerLimits limits = limits_of(&info->limits);
    const LevelRequest request = {header, span_of(bytes, size), limits, image};
    return code(f(reader_of(header.layout), request));
}

// The same for a level of the surface. Callers count levels from the finest one that the file has, request.level counts
// from the finest one before the file was cut.
template <class F>
gim_status with_level(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                      const F& f) {
    return with_image(info, bytes, size, image, [&](const LevelReader& reader, LevelRequest request) {
        if (level >= GIM_MAX_LEVELS) return Status::kNoSuchLevel;
        request.level = level + request.header.cut_levels;
        return f(reader, request);
    });
}

// Opens a level of the plane of a kind. request.level: of the plane.
inline Status open_plane(const LevelReader& reader, const LevelRequest& request, uint32_t kind, PlaneLevel* plane) {
    if (kind >= kPlaneKinds) return Status::kBadArgument;
    Chunk chunk;
    uint64_t offset = 0;
    if (!find_chunk(request.header, plane_type(kind), &chunk, &offset)) return Status::kNoSuchPlane;
    return reader.open_plane(request, chunk, offset, plane);
}

}  // namespace gim

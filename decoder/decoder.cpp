// The C interface of gim/decoder.h: checks arguments and calls the functions of the layout (level_reader.h).
#include <algorithm>
#include <cstring>

#include "decoder/layout/level_reader.h"
#include "decoder/reopen.h"
#include "decoder/told_bounds.h"
#include "decoder/with_image.h"
#include "gim/decoder.h"

using namespace gim;

const char* gim_status_text(gim_status status) {
    switch (static_cast<Status>(status)) {
        case Status::kNeedMoreInput:
            return "the data ends too early";
        case Status::kOk:
            return "fine";
        case Status::kNotGim:
            return "not a .gim file";
        case Status::kUnsupportedVersion:
            return "made by a newer version: this reader does not know all of it";
        case Status::kMalformed:
            return "malformed: no writer produces such bytes";
        case Status::kLimitExceeded:
            return "larger than the caller's limits";
        case Status::kBadArgument:
            return "bad argument";
        case Status::kScratchTooSmall:
            return "scratch or output memory is too small";
        case Status::kChecksum:
            return "damaged: a checksum does not match";
        case Status::kNoSuchLevel:
            return "no such level: coarser than the coarsest one of this image";
        case Status::kNoSuchPlane:
            return "no such plane: the file has no normals, colours or labels of their own";
    }
    return "unknown status";
}

gim_status gim_read_info(const void* bytes, size_t size, const gim_limits* limits, gim_info* info) {
    if (!info || (!bytes && size > 0)) return code(Status::kBadArgument);
    Header header;
    const ContainerLimits l = limits_of(limits);
    if (Status s = parse_header(span_of(bytes, size), l, &header); s != Status::kOk) return code(s);
    *info = {};
    info->version = kFormatVersion;
    info->layout =
        header.layout == FileLayout::kRaster ? uint32_t{GIM_LAYOUT_MCGIM} : static_cast<uint32_t>(header.layout);
    info->coding = static_cast<uint32_t>(header.coding);
    info->bits = header.bits;
    info->image_count = header.image_count();
    info->level_count = header.kept_levels();
    info->chunk_count = header.chunk_count;
    info->sample_count = header.sample_count;
    info->file_size = header.file_size;
    info->is_relative = header.wide_origin ? 1 : 0;
    for (size_t k = 0; k < 3; ++k)
        info->origin[k] = header.wide_origin ? (*header.wide_origin)[k] : double{header.origin[k]};
    info->step = header.step;
    info->quantizer = header.quantizer;
    info->index_size = header.index_size;
    tell_bounds(header, info);
    info->limits = {l.max_samples, l.max_images, l.max_side};
    return code(Status::kOk);
}

gim_status gim_read_box(const gim_info* info, const void* bytes, size_t size, uint32_t image, gim_box* box) {
    if (!box) return code(Status::kBadArgument);
    Header header;
    if (Status s = reopen(info, bytes, size, &header); s != Status::kOk) return code(s);
    if (image >= header.image_count()) return code(Status::kBadArgument);
    *box = image_box(header, image);
    return code(Status::kOk);
}

gim_status gim_read_level_info(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                               gim_level_info* level_info) {
    if (!level_info) return code(Status::kBadArgument);
    return with_level(info, bytes, size, image, level, [&](const LevelReader& reader, const LevelRequest& request) {
        const Status status = reader.level_info(request, level_info);
        if (status != Status::kOk) return status;
        level_info->coarsest_level -= request.header.cut_levels;
        level_info->rms_error = info->level_rms_error[level];
        level_info->max_error = info->level_max_error[level];
        level_info->box = image_box(request.header, image);
        return status;
    });
}

gim_status gim_decode_positions(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                                float* positions, void* scratch, size_t scratch_bytes) {
    return gim_decode_grid(info, bytes, size, image, level, positions, nullptr, nullptr, nullptr, scratch,
                           scratch_bytes);
}

gim_status gim_decode_mesh(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                           float* positions, float* normals, float* texcoords, uint32_t* triangles, void* scratch,
                           size_t scratch_bytes) {
    if (!positions) return code(Status::kBadArgument);
    return with_level(info, bytes, size, image, level, [&](const LevelReader& reader, const LevelRequest& request) {
        return reader.mesh(request, {positions, normals, texcoords, triangles, nullptr}, {scratch, scratch_bytes});
    });
}

gim_status gim_decode_hard_mesh(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                                uint32_t* vertex_count, float* positions, float* normals, float* texcoords,
                                uint32_t* triangles, void* scratch, size_t scratch_bytes) {
    if (!positions || !vertex_count) return code(Status::kBadArgument);
    return with_level(info, bytes, size, image, level, [&](const LevelReader& reader, const LevelRequest& request) {
        gim_level_info shared;
        if (Status s = reader.level_info(request, &shared); s != Status::kOk) return s;
        *vertex_count = shared.vertex_count;
        return reader.mesh(request, {positions, normals, texcoords, triangles, vertex_count}, {scratch, scratch_bytes});
    });
}

gim_status gim_decode_grid(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                           float* positions, float* normals, float* texcoords, uint32_t* triangles, void* scratch,
                           size_t scratch_bytes) {
    if (!positions) return code(Status::kBadArgument);
    return with_level(info, bytes, size, image, level, [&](const LevelReader& reader, const LevelRequest& request) {
        return reader.grid(request, {positions, normals, texcoords, triangles, nullptr}, {scratch, scratch_bytes});
    });
}

gim_status gim_read_chunk(const gim_info* info, const void* bytes, size_t size, uint32_t i, gim_chunk* chunk) {
    if (!chunk) return code(Status::kBadArgument);
    Header header;
    if (Status s = reopen(info, bytes, size, &header); s != Status::kOk) return code(s);
    if (i >= header.chunk_count) return code(Status::kBadArgument);
    ChunkWalk walk(header);
    Chunk c;
    uint64_t offset = 0;
    uint32_t levels_seen = 0;
    for (uint32_t k = 0; k <= i && walk.next(&c, &offset); ++k) levels_seen += c.type == ChunkType::kLevel;
    *chunk = {};
    const char* name = "????";
    if (c.type == ChunkType::kSeams) name = "SEAM";
    if (c.type == ChunkType::kLevel) name = "LEVL";
    if (c.type == ChunkType::kText) name = "META";
    if (c.type == ChunkType::kNormals) name = "NRML";
    if (c.type == ChunkType::kColors) name = "COLR";
    if (c.type == ChunkType::kDisplacements) name = "DISP";
    if (c.type == ChunkType::kLabels) name = "LABL";
    std::memcpy(chunk->name, name, 4);
    chunk->type = static_cast<uint32_t>(c.type);
    chunk->level = c.type == ChunkType::kLevel ? static_cast<int32_t>(header.kept_levels() - levels_seen) : -1;
    chunk->offset = offset;
    chunk->size = c.size;
    chunk->raw_size = c.raw_size;
    std::span<const uint8_t> payload;
    chunk->intact = read_payload(span_of(bytes, size), c, offset, &payload) == Status::kOk;
    return code(Status::kOk);
}

gim_status gim_read_seams(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                          uint32_t* class_of, uint32_t* path_count) {
    return with_level(info, bytes, size, image, level, [&](const LevelReader& reader, const LevelRequest& request) {
        return reader.seams(request, class_of, path_count);
    });
}

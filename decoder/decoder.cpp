// The C interface of gim/decoder.h over the parts in this folder.
#include <algorithm>
#include <cstring>

#include "decoder/charts/read_charts.h"
#include "decoder/reopen.h"
#include "decoder/squares/square_decoder.h"
#include "decoder/squares/triangulate.h"
#include "gim/decoder.h"

namespace gim {

namespace {

gim_status code(Status status) { return static_cast<gim_status>(status); }

std::span<const uint8_t> span_of(const void* bytes, size_t size) { return {static_cast<const uint8_t*>(bytes), size}; }

// One level of one image, ready to be decoded.
struct Level {
    Header header;
    SeamTable seams;
    uint32_t side = 0, coarsest = 0, class_count = 0;
    float* samples = nullptr;  // in units, after decode()
    ImageWorkspace ws;
};

// The header, for calls on one image.
Status open_image(const gim_info* info, const void* bytes, size_t size, uint32_t image, Header* header) {
    if (Status s = reopen(info, bytes, size, header); s != Status::kOk) return s;
    return image < header->image_count() ? Status::kOk : Status::kBadArgument;
}

// `out->header` is of a file of squares. out->coarsest is only sought up to `most`, at least `level`.
Status open_level(std::span<const uint8_t> file, uint32_t image, uint32_t level, uint32_t most, Level* out) {
    if (Status s = read_seams(out->header, file, image, &out->seams); s != Status::kOk) return s;
    const uint32_t steps = out->header.side(image) - 1;
    out->coarsest = 0;
    while (out->coarsest < most && out->coarsest + 1 < out->header.level_count_of(image) &&
           level_is_closed(out->seams, (steps >> (out->coarsest + 1)) + 1))
        ++out->coarsest;
    if (level > out->coarsest) return Status::kNoSuchLevel;
    out->side = (steps >> level) + 1;
    out->class_count = ring_class_count(out->seams, out->side);
    return Status::kOk;
}

uint64_t scratch_size(uint32_t side) {
    Arena arena(nullptr);
    (void)lay_out(side, &arena);
    return arena.used();
}

Status decode(std::span<const uint8_t> file, uint32_t image, uint32_t level, const Memory& scratch, Level* out) {
    if (Status s = open_level(file, image, level, level, out); s != Status::kOk) return s;
    if (!scratch.bytes || reinterpret_cast<uintptr_t>(scratch.bytes) % 16 != 0) return Status::kBadArgument;
    if (scratch.size < scratch_size(out->side)) return Status::kScratchTooSmall;
    Arena arena(scratch.bytes);
    out->ws = lay_out(out->side, &arena);
    return decode_level(out->header, file, image, level, out->seams, out->ws, &out->samples);
}

// The vertices of the closed mesh with their first samples, in runs along a row: f(vertex, sample, count).
template <class F>
void for_each_run(const Level& level, const F& f) {
    const uint32_t side = level.side;
    uint32_t next = 0;
    for (uint32_t k = 0; k < ring_length(side); ++k) {
        if (level.ws.class_of[k] == next) f(next++, ring_point(side, k), 1);
    }
    for (uint32_t r = 1; r + 1 < side; ++r, next += side - 2) f(next, GridPoint{r, 1}, side - 2);
}

}  // namespace
}  // namespace gim

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
            return "no such plane: the file has no normals or colours of their own";
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
    info->layout = static_cast<uint32_t>(header.layout);
    info->coding = static_cast<uint32_t>(header.coding);
    info->bits = header.bits;
    info->image_count = header.image_count();
    info->level_count = header.level_count;
    info->chunk_count = header.chunk_count;
    info->sample_count = header.sample_count;
    info->file_size = header.file_size;
    std::copy(header.origin.begin(), header.origin.end(), info->origin);
    info->step = header.step;
    for (size_t k = 0; k < header.level_psnr.size(); ++k)
        info->level_psnr[header.level_psnr.size() - 1 - k] = 0.5f * header.level_psnr[k];
    info->quantizer = header.quantizer;
    info->index_size = header.index_size;
    info->limits = {l.max_samples, l.max_images, l.max_side};
    return code(Status::kOk);
}

gim_status gim_read_level_info(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                               gim_level_info* level_info) {
    if (!level_info) return code(Status::kBadArgument);
    Level l;
    if (Status s = open_image(info, bytes, size, image, &l.header); s != Status::kOk) return code(s);
    if (l.header.layout == FileLayout::kCharts)
        return code(chart_level_info(l.header, span_of(bytes, size), limits_of(&info->limits), level, level_info));
    if (Status s = open_level(span_of(bytes, size), image, level, UINT32_MAX, &l); s != Status::kOk) return code(s);
    Chunk chunk;
    uint64_t offset = 0;
    if (Status s = find_level_chunk(l.header, level, &chunk, &offset); s != Status::kOk) return code(s);
    *level_info = {};
    level_info->side = level_info->width = level_info->height = l.side;
    level_info->coarsest_level = l.coarsest;
    level_info->vertex_count = l.class_count + (l.side - 2) * (l.side - 2);
    level_info->triangle_count = 2 * (l.side - 1) * (l.side - 1);
    level_info->prefix_size = offset + chunk.size;
    level_info->scratch_size = scratch_size(l.side);
    return code(Status::kOk);
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
    Level l;
    if (Status s = open_image(info, bytes, size, image, &l.header); s != Status::kOk) return code(s);
    if (l.header.layout == FileLayout::kCharts)
        return code(decode_chart_mesh(l.header, span_of(bytes, size), limits_of(&info->limits), level,
                                      {positions, normals, texcoords, triangles}, {scratch, scratch_bytes}));
    if (Status s = decode(span_of(bytes, size), image, level, {scratch, scratch_bytes}, &l); s != Status::kOk)
        return code(s);
    const auto at = [&l](GridPoint p) { return (size_t{p.row} * l.side + p.column) * 3; };
    for_each_run(l, [&](uint32_t v, GridPoint p, uint32_t count) {
        to_object(l.header, l.samples + at(p), positions + size_t{v} * 3, count);
    });
    if (normals) {
        sample_normals(l.samples, l.side, l.ws.class_of, l.class_count, l.ws.fuse.sums, l.ws.normals);
        for_each_run(l, [&](uint32_t v, GridPoint p, uint32_t count) {
            std::copy_n(l.ws.normals + at(p), size_t{count} * 3, normals + size_t{v} * 3);
        });
    }
    if (texcoords) {
        const float last = static_cast<float>(l.side - 1);
        for_each_run(l, [&](uint32_t v, GridPoint p, uint32_t count) {
            for (uint32_t i = 0; i < count; ++i) {
                texcoords[size_t{v + i} * 2] = static_cast<float>(p.column + i) / last;
                texcoords[size_t{v + i} * 2 + 1] = static_cast<float>(p.row) / last;
            }
        });
    }
    if (triangles) {
        const VertexNumbers numbers = {l.side, l.ws.class_of, l.class_count};
        triangulate(l.samples, l.side, l.ws.class_of, numbers, l.ws.triangulate, triangles);
    }
    return code(Status::kOk);
}

gim_status gim_decode_grid(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                           float* positions, float* normals, float* texcoords, uint32_t* triangles, void* scratch,
                           size_t scratch_bytes) {
    if (!positions) return code(Status::kBadArgument);
    Level l;
    if (Status s = open_image(info, bytes, size, image, &l.header); s != Status::kOk) return code(s);
    if (l.header.layout == FileLayout::kCharts)
        return code(decode_chart_grid(l.header, span_of(bytes, size), limits_of(&info->limits), level,
                                      {positions, normals, texcoords, triangles}, {scratch, scratch_bytes}));
    if (Status s = decode(span_of(bytes, size), image, level, {scratch, scratch_bytes}, &l); s != Status::kOk)
        return code(s);
    to_object(l.header, l.samples, positions, size_t{l.side} * l.side);
    if (normals) sample_normals(l.samples, l.side, l.ws.class_of, l.class_count, l.ws.fuse.sums, normals);
    if (texcoords) {
        const float last = static_cast<float>(l.side - 1);
        for (uint32_t i = 0; i < l.side * l.side; ++i) {
            texcoords[size_t{i} * 2] = static_cast<float>(i % l.side) / last;
            texcoords[size_t{i} * 2 + 1] = static_cast<float>(i / l.side) / last;
        }
    }
    if (triangles) {
        const VertexNumbers numbers = {l.side, nullptr, 0};
        triangulate(l.samples, l.side, l.ws.class_of, numbers, l.ws.triangulate, triangles);
    }
    return code(Status::kOk);
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
    std::memcpy(chunk->name, name, 4);
    chunk->type = static_cast<uint32_t>(c.type);
    chunk->level = c.type == ChunkType::kLevel ? static_cast<int32_t>(header.level_count - levels_seen) : -1;
    chunk->offset = offset;
    chunk->size = c.size;
    chunk->raw_size = c.raw_size;
    std::span<const uint8_t> payload;
    chunk->intact = read_payload(span_of(bytes, size), c, offset, &payload) == Status::kOk;
    return code(Status::kOk);
}

gim_status gim_read_seams(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                          uint32_t* class_of, uint32_t* path_count) {
    Level l;
    if (Status s = open_image(info, bytes, size, image, &l.header); s != Status::kOk) return code(s);
    if (l.header.layout == FileLayout::kCharts) {
        if (class_of) return code(Status::kBadArgument);
        return code(count_chart_paths(l.header, span_of(bytes, size), limits_of(&info->limits), level, path_count));
    }
    if (Status s = open_level(span_of(bytes, size), image, level, level, &l); s != Status::kOk) return code(s);
    if (class_of) ring_classes(l.seams, l.side, {class_of, ring_length(l.side)});
    if (path_count) *path_count = l.seams.path_count;
    return code(Status::kOk);
}

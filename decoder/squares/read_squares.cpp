#include "decoder/squares/read_squares.h"

#include <algorithm>

#include "decoder/squares/square_decoder.h"
#include "decoder/squares/triangulate.h"

namespace gim {
namespace {

// One level of one image, ready to be decoded.
struct Level {
    SeamTable seams;
    uint32_t side = 0, coarsest = 0, class_count = 0;
    float* samples = nullptr;  // in units, after decode()
    ImageWorkspace ws;
};

// Looks for level->coarsest up to `most` only, which is at least request.level.
Status open_level(const LevelRequest& request, uint32_t most, Level* level) {
    const Header& header = request.header;
    if (Status s = read_seams(header, request.file, request.image, &level->seams); s != Status::kOk) return s;
    const uint32_t steps = header.side(request.image) - 1;
    level->coarsest = 0;
    while (level->coarsest < most && level->coarsest + 1 < header.level_count_of(request.image) &&
           level_is_closed(level->seams, (steps >> (level->coarsest + 1)) + 1))
        ++level->coarsest;
    if (header.cut_levels > level->coarsest && most >= header.cut_levels) return Status::kMalformed;
    if (request.level > level->coarsest) return Status::kNoSuchLevel;
    level->side = (steps >> request.level) + 1;
    level->class_count = ring_class_count(level->seams, level->side);
    return Status::kOk;
}

// Halves the steps between samples so many times.
Status make_finer(uint32_t times, Level* level) {
    if (times > kMaxSideExponent || (uint64_t{level->side - 1} << times) > (uint64_t{1} << kMaxSideExponent))
        return Status::kLimitExceeded;
    level->side = ((level->side - 1) << times) + 1;
    level->class_count = ring_class_count(level->seams, level->side);
    return Status::kOk;
}

uint64_t scratch_size(uint32_t side) {
    Arena arena(nullptr);
    (void)lay_out(side, &arena);
    return arena.used();
}

Status decode(const LevelRequest& request, const Memory& scratch, Level* level) {
    if (Status s = open_level(request, request.level, level); s != Status::kOk) return s;
    if (Status s = check_scratch(scratch, scratch_size(level->side)); s != Status::kOk) return s;
    Arena arena(scratch.bytes);
    level->ws = lay_out(level->side, &arena);
    return decode_level(request.header, request.file, request.image, request.level, level->seams, level->ws,
                        &level->samples);
}

// Calls f(vertex, sample, count) for all vertices of the closed mesh with their first samples, in runs along a row.
template <class F>
void for_each_run(const Level& level, const F& f) {
    const uint32_t side = level.side;
    uint32_t next = 0;
    for (uint32_t k = 0; k < ring_length(side); ++k) {
        if (level.ws.class_of[k] == next) f(next++, ring_point(side, k), 1);
    }
    for (uint32_t r = 1; r + 1 < side; ++r, next += side - 2) f(next, GridPoint{r, 1}, side - 2);
}

// Sets the texture coordinates of `count` samples along a row.
void set_texcoords(uint32_t side, GridPoint p, uint32_t count, float* texcoords) {
    const float last = static_cast<float>(side - 1);
    for (uint32_t i = 0; i < count; ++i) {
        texcoords[size_t{i} * 2] = static_cast<float>(p.column + i) / last;
        texcoords[size_t{i} * 2 + 1] = static_cast<float>(p.row) / last;
    }
}

// The classes on the ring of a level and of the coarsest one, and what find_mates() needs.
struct GlueWork {
    uint32_t *class_of, *coarse_class_of, *mates;
    Quad* quads;
    size_t mates_size;
};
GlueWork lay_out_glue_work(uint32_t side, uint32_t coarse_side, Arena* arena) {
    const size_t cells = size_t{coarse_side - 1} * (coarse_side - 1);
    GlueWork work{};
    work.mates_size = 4 * cells + size_t{coarse_side} * coarse_side + 1;
    work.class_of = arena->take<uint32_t>(ring_length(side));
    work.coarse_class_of = arena->take<uint32_t>(ring_length(coarse_side));
    work.mates = arena->take<uint32_t>(work.mates_size);
    work.quads = arena->take<Quad>(cells);
    return work;
}

// Corner i of a cell, then the direction to the next one.
constexpr GridPoint kCorner[4] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
constexpr int32_t kAlong[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};

}  // namespace

Status square_level_info(const LevelRequest& request, gim_level_info* info) {
    Level l;
    if (Status s = open_level(request, UINT32_MAX, &l); s != Status::kOk) return s;
    Chunk chunk;
    uint64_t offset = 0;
    if (Status s = find_level_chunk(request.header, request.level, &chunk, &offset); s != Status::kOk) return s;
    *info = {};
    info->side = info->width = info->height = l.side;
    info->coarsest_level = l.coarsest;
    info->vertex_count = l.class_count + (l.side - 2) * (l.side - 2);
    info->triangle_count = 2 * (l.side - 1) * (l.side - 1);
    info->prefix_size = offset + chunk.size;
    info->scratch_size = scratch_size(l.side);
    return Status::kOk;
}

Status decode_square_mesh(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch) {
    Level l;
    if (Status s = decode(request, scratch, &l); s != Status::kOk) return s;
    const Header& header = request.header;
    const auto at = [&l](GridPoint p) { return (size_t{p.row} * l.side + p.column) * 3; };
    for_each_run(l, [&](uint32_t v, GridPoint p, uint32_t count) {
        to_object(header.origin, header.step, l.samples + at(p), out.positions + size_t{v} * 3, count);
    });
    if (out.normals) {
        sample_normals(l.samples, l.side, l.ws.class_of, l.class_count, l.ws.fuse.sums, l.ws.normals);
        for_each_run(l, [&](uint32_t v, GridPoint p, uint32_t count) {
            std::copy_n(l.ws.normals + at(p), size_t{count} * 3, out.normals + size_t{v} * 3);
        });
    }
    if (out.texcoords) {
        for_each_run(l, [&](uint32_t v, GridPoint p, uint32_t count) {
            set_texcoords(l.side, p, count, out.texcoords + size_t{v} * 2);
        });
    }
    if (out.triangles) {
        const VertexNumbers numbers = {l.side, l.ws.class_of, l.class_count};
        triangulate(l.samples, l.side, l.ws.class_of, numbers, l.ws.triangulate, out.triangles);
    }
    return Status::kOk;
}

Status decode_square_grid(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch) {
    Level l;
    if (Status s = decode(request, scratch, &l); s != Status::kOk) return s;
    const size_t row_size = l.side;
    to_object(request.header.origin, request.header.step, l.samples, out.positions, row_size * row_size);
    if (out.normals) sample_normals(l.samples, l.side, l.ws.class_of, l.class_count, l.ws.fuse.sums, out.normals);
    if (out.texcoords) {
        for (uint32_t r = 0; r < l.side; ++r) set_texcoords(l.side, {r, 0}, l.side, out.texcoords + r * row_size * 2);
    }
    if (out.triangles) {
        const VertexNumbers numbers = {l.side, nullptr, 0};
        triangulate(l.samples, l.side, l.ws.class_of, numbers, l.ws.triangulate, out.triangles);
    }
    return Status::kOk;
}

Status read_square_seams(const LevelRequest& request, uint32_t* class_of, uint32_t* path_count) {
    Level l;
    if (Status s = open_level(request, request.level, &l); s != Status::kOk) return s;
    if (class_of) ring_classes(l.seams, l.side, {class_of, ring_length(l.side)});
    if (path_count) *path_count = l.seams.path_count;
    return Status::kOk;
}

Status square_domain_shape(const LevelRequest& request, DomainShape* shape, uint64_t* scratch_size) {
    Level l;
    if (Status s = open_level(request, UINT32_MAX, &l); s != Status::kOk) return s;
    const uint32_t coarsest_intervals = 1u << (l.coarsest - request.level), cells = (l.side - 1) / coarsest_intervals;
    if (Status s = make_finer(request.finer, &l); s != Status::kOk) return s;
    const uint32_t intervals = coarsest_intervals << request.finer;
    *shape = {cells * cells, intervals, l.class_count + (l.side - 2) * (l.side - 2), cells, intervals};
    Arena arena(nullptr);
    (void)lay_out_glue_work(l.side, cells + 1, &arena);
    *scratch_size = arena.used();
    return Status::kOk;
}

Status read_square_glue(const LevelRequest& request, const DomainShape& shape, void* scratch, TileGlue* glue) {
    Level l;
    if (Status s = open_level(request, request.level, &l); s != Status::kOk) return s;
    if (Status s = make_finer(request.finer, &l); s != Status::kOk) return s;
    const uint32_t n = shape.intervals, cells = (l.side - 1) / n;
    Arena arena(scratch);
    const GlueWork work = lay_out_glue_work(l.side, cells + 1, &arena);
    ring_classes(l.seams, l.side, {work.class_of, ring_length(l.side)});
    ring_classes(l.seams, cells + 1, {work.coarse_class_of, ring_length(cells + 1)});
    const uint32_t coarse_classes = ring_class_count(l.seams, cells + 1);
    const VertexNumbers fine{l.side, work.class_of, l.class_count};
    const VertexNumbers coarse{cells + 1, work.coarse_class_of, coarse_classes};
    for (uint32_t t = 0; t < shape.tiles; ++t) {
        const uint32_t row = t / cells, column = t % cells;
        for (uint32_t i = 0; i < 4; ++i) {
            const uint32_t r = row + kCorner[i].row, c = column + kCorner[i].column, h = 4 * t + i;
            const auto number = [&](uint32_t k) {
                return fine.at(r * n + k * static_cast<uint32_t>(kAlong[i][0]),
                               c * n + k * static_cast<uint32_t>(kAlong[i][1]));
            };
            work.quads[t][i] = coarse.at(r, c);
            glue->corner[h] = number(0);
            glue->along[h] = n > 1 ? number(1) : 0;
            glue->step[h] = n > 2 ? static_cast<int32_t>(number(2) - number(1)) : 0;
            for (uint32_t k = 3; k < n; ++k) {
                if (number(k) != number(1) + (k - 1) * static_cast<uint32_t>(glue->step[h])) return Status::kMalformed;
            }
        }
        glue->inner[t] = n > 1 ? fine.at(row * n + 1, column * n + 1) : 0;
    }
    glue->row_step = l.side - 2;
    const QuadFault fault = find_mates({work.quads, shape.tiles}, coarse_classes + (cells - 1) * (cells - 1),
                                       {work.mates, work.mates_size}, glue->mate);
    return fault.kind == QuadFault::Kind::kFine ? Status::kOk : Status::kMalformed;
}

Status open_square_plane(const LevelRequest& request, const Chunk& chunk, uint64_t offset, PlaneLevel* plane) {
    if (Status s = read_seams(request.header, request.file, request.image, &plane->seams); s != Status::kOk) return s;
    if (Status s = read_plane_chunk(request, chunk, offset, plane); s != Status::kOk) return s;
    // The ring's classes exist only on grids at least as fine as the node grid.
    const uint32_t side = plane->chunk.side(request.image), least = std::max(3u, plane->seams.node_side);
    if (side < least) return Status::kMalformed;
    while (((side - 1) >> (plane->coarsest + 1)) + 1 >= least) ++plane->coarsest;
    if (request.level > plane->coarsest) return Status::kNoSuchLevel;
    plane->width = plane->height = ((side - 1) >> request.level) + 1;
    plane->shape = square_shape(plane->chunk.side_exponents[request.image], request.level, {plane->chunk.quantizer}, 0);
    return Status::kOk;
}

uint64_t square_plane_scratch_size(const LevelRequest&, const PlaneLevel& plane) {
    Arena arena(nullptr);
    (void)lay_out_plane(plane.width, &arena);
    return arena.used();
}

Status decode_square_plane(const LevelRequest&, const PlaneLevel& plane, void* scratch, float* values) {
    Arena arena(scratch);
    const PlaneWorkspace ws = lay_out_plane(plane.width, &arena);
    if (Status s = decode_pyramid_plane(plane, ws.pyramid, values); s != Status::kOk) return s;
    ring_classes(plane.seams, plane.width, {ws.class_of, ring_length(plane.width)});
    average_classes(plane.width, ws.class_of, ring_class_count(plane.seams, plane.width), values, ws.fuse);
    return Status::kOk;
}

}  // namespace gim

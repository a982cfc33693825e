#include "decoder/tiles/read_tiles.h"

#include <algorithm>
#include <limits>

#include "decoder/tiles/hard_vertices.h"
#include "decoder/tiles/tile_decoder.h"
#include "decoder/tiles/tile_surface.h"

namespace gim {
namespace {

struct Workspace {
    TileWorkspace tiles;
    TriangulateTilesWork triangulate;

    void lay_out(const TileShape& shape, uint32_t level, Arena* arena) {
        const size_t width = size_t{shape.intervals(level)} + 1;
        tiles = lay_out_tiles(shape, level, arena);
        triangulate = {arena->take<float>(6 * width), arena->take<uint32_t>(width), arena->take<uint32_t>(2 * width)};
    }
};

uint64_t scratch_size(const TileShape& shape, uint32_t level) {
    Workspace ws;
    Arena arena(nullptr);
    ws.lay_out(shape, level, &arena);
    return arena.used();
}

// Calls f(surface, workspace, spare) with the decoded level. spare: room for a triple per vertex.
template <class F>
Status with_surface(const LevelRequest& request, const Memory& scratch, const F& f) {
    const TileShape& shape = request.header.tiles;
    if (request.level >= request.header.level_count) return Status::kNoSuchLevel;
    if (Status s = check_scratch(scratch, scratch_size(shape, request.level)); s != Status::kOk) return s;
    Workspace ws;
    Arena arena(scratch.bytes);
    ws.lay_out(shape, request.level, &arena);
    float* samples = nullptr;
    if (Status s = decode_tiles(request.header, request.file, request.level, ws.tiles, &samples); s != Status::kOk)
        return s;
    f(TileSurface{ws.tiles.complex, shape.intervals(request.level), samples}, ws,
      static_cast<float*>(ws.tiles.samples[1]));
    return Status::kOk;
}

// Texture coordinates of samples of the atlas at full resolution.
class AtlasTexcoords {
  public:
    AtlasTexcoords(const TileShape& shape, uint32_t level) : atlas_(shape.tiles, shape.intervals(0)), level_(level) {}
    void set(uint32_t tile, uint32_t row, uint32_t column, float* uv) const {
        uv[0] = static_cast<float>(atlas_.column(tile) + (column << level_)) / static_cast<float>(atlas_.width() - 1);
        uv[1] = static_cast<float>(atlas_.row(tile) + (row << level_)) / static_cast<float>(atlas_.height() - 1);
    }

  private:
    TileAtlas atlas_;
    uint32_t level_;
};

// Texels a sample at full resolution, as an exponent of 2.
uint32_t texels_of(const LevelRequest& request, const PlaneLevel& plane) {
    return plane.chunk.side_exponents[request.image];
}

TileShape plane_shape(const LevelRequest& request, const PlaneLevel& plane) {
    return tile_plane_shape(request.header.tiles, texels_of(request, plane));
}

// Where the texels of a level of a plane lie: as the samples of the atlas at full resolution, and between them.
class AtlasTexels {
  public:
    AtlasTexels(const LevelRequest& request, const PlaneLevel& plane)
        : tiles_(request.header.tiles.tiles),
          atlas_(tiles_, request.header.tiles.intervals(0)),
          exponent_(texels_of(request, plane) - request.level),
          last_(request.header.tiles.intervals(0) << exponent_) {}

    uint32_t width() const { return static_cast<uint32_t>(texels_along(atlas_.width(), exponent_)); }
    uint32_t height() const { return static_cast<uint32_t>(texels_along(atlas_.height(), exponent_)); }

    // samples: per tile (last + 1)^2 triples. Texels between slots repeat the nearest one of a slot.
    void fill(const float* samples, float* values) const {
        std::fill_n(values, 3 * size_t{width()} * height(), 0.0f);
        for (uint32_t t = 0; t < tiles_; ++t) {
            const Extent rows = around(atlas_.row(t), height()), columns = around(atlas_.column(t), width());
            const float* tile = samples + 3 * t * size_t{last_ + 1} * (last_ + 1);
            for (uint32_t y = rows.begin; y < rows.end; ++y) {
                const float* row = tile + 3 * size_t{rows.place(y, last_)} * (last_ + 1);
                float* to = values + 3 * (size_t{y} * width() + columns.begin);
                for (uint32_t x = columns.begin; x < columns.end; ++x, to += 3)
                    std::copy_n(row + 3 * size_t{columns.place(x, last_)}, 3, to);
            }
        }
    }

  private:
    // The texels of a slot and those around it that are nearer to it than to the next, along one axis.
    struct Extent {
        uint32_t first, begin, end;
        uint32_t place(uint32_t x, uint32_t last) const { return x < first ? 0 : std::min(x - first, last); }
    };
    Extent around(uint32_t first_sample, uint32_t size) const {
        const uint32_t gap = 1u << exponent_, first = first_sample << exponent_;
        return {first, first - std::min(first, gap / 2), std::min(size, first + last_ + (gap + 1) / 2)};
    }

    uint32_t tiles_;
    TileAtlas atlas_;
    uint32_t exponent_;
    uint32_t last_;  // of the texels along a side of a tile
};

}  // namespace

Status tile_level_info(const LevelRequest& request, gim_level_info* info) {
    const Header& header = request.header;
    const TileShape& shape = header.tiles;
    if (request.level >= header.level_count) return Status::kNoSuchLevel;
    std::span<const uint8_t> seams;
    if (Status s = read_seam_payload(header, request.file, &seams); s != Status::kOk) return s;
    Chunk chunk;
    uint64_t offset = 0;
    if (Status s = find_level_chunk(header, request.level, &chunk, &offset); s != Status::kOk) return s;
    const uint32_t side = shape.intervals(request.level);
    const TileAtlas atlas(shape.tiles, side);
    *info = {};
    info->width = atlas.width();
    info->height = atlas.height();
    info->coarsest_level = header.level_count - 1;
    info->vertex_count = shape.vertices + shape.edges() * (side - 1) + shape.tiles * (side - 1) * (side - 1);
    info->triangle_count = 2 * shape.tiles * side * side;
    info->prefix_size = offset + chunk.size;
    info->scratch_size = scratch_size(shape, request.level);
    return Status::kOk;
}

Status decode_tile_mesh(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch) {
    const Header& header = request.header;
    const AtlasTexcoords texcoords(header.tiles, request.level);
    return with_surface(request, scratch, [&](const TileSurface& surface, const Workspace& ws, float*) {
        const uint32_t width = surface.side + 1;
        for_each_run(surface, [&](uint32_t vertex, uint32_t tile, uint32_t first, uint32_t count, int32_t stride) {
            const float* samples = surface.samples + 3 * (tile * surface.tile_size() + first);
            float* positions = out.positions + 3 * size_t{vertex};
            if (stride == 1) {
                to_object(header.origin, header.step, samples, positions, count);
            } else {
                for (uint32_t i = 0; i < count; ++i)
                    to_object(header.origin, header.step, samples + ptrdiff_t{3} * stride * i, positions + 3 * i);
            }
            if (!out.texcoords) return;
            for (uint32_t i = 0; i < count; ++i) {
                const uint32_t at = first + static_cast<uint32_t>(stride) * i;
                texcoords.set(tile, at / width, at % width, out.texcoords + 2 * (size_t{vertex} + i));
            }
        });
        const auto finish = [&](const TileNumbers& numbers, uint32_t count) {
            if (out.normals) tile_normals(surface, numbers, count, ws.triangulate.numbers, out.normals);
            if (out.triangles) triangulate_tiles(surface, ws.triangulate, numbers, out.triangles);
        };
        const MeshNumbers shared = {surface.numbers(), surface.side};
        if (!out.hard_vertices || !ws.tiles.is_sharp) return finish(TileNumbers(shared), surface.numbers().count());
        const HardVertices hard =
            split_sharp_edges(surface, ws.tiles.is_sharp, ws.tiles.quad_code.next, ws.tiles.quad_code.previous);
        for_each_copy(hard, [&](uint32_t vertex, uint32_t tile, uint32_t sample) {
            to_object(header.origin, header.step, surface.samples + 3 * (tile * surface.tile_size() + sample),
                      out.positions + 3 * size_t{vertex});
            if (out.texcoords) texcoords.set(tile, sample / width, sample % width, out.texcoords + 2 * size_t{vertex});
        });
        *out.hard_vertices = hard.count;
        finish(TileNumbers(hard), hard.count);
    });
}

Status decode_tile_grid(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch) {
    const Header& header = request.header;
    const AtlasTexcoords texcoords(header.tiles, request.level);
    const TileAtlas atlas(header.tiles.tiles,
                          request.level < header.level_count ? header.tiles.intervals(request.level) : 1);
    return with_surface(request, scratch, [&](const TileSurface& surface, const Workspace& ws, float* spare) {
        const uint32_t width = surface.side + 1;
        const auto count = static_cast<size_t>(atlas.samples());
        std::fill_n(out.positions, 3 * count, std::numeric_limits<float>::quiet_NaN());
        if (out.normals) std::fill_n(out.normals, 3 * count, 0.0f);
        if (out.texcoords) std::fill_n(out.texcoords, 2 * count, 0.0f);
        const MeshNumbers vertices = {surface.numbers(), surface.side};
        if (out.normals)
            tile_normals(surface, TileNumbers(vertices), surface.numbers().count(), ws.triangulate.numbers, spare);
        for (uint32_t t = 0; t < surface.complex.tiles; ++t) {
            for (uint32_t row = 0; row < width; ++row) {
                const float* samples = surface.samples + 3 * (t * surface.tile_size() + row * width);
                const size_t to = size_t{atlas.row(t) + row} * atlas.width() + atlas.column(t);
                to_object(header.origin, header.step, samples, out.positions + 3 * to, width);
                if (out.normals) {
                    uint32_t* numbers = ws.triangulate.numbers;
                    vertices.load(t, row, numbers);
                    for (size_t c = 0; c < width; ++c)
                        std::copy_n(spare + 3 * size_t{numbers[c]}, 3, out.normals + 3 * (to + c));
                }
                if (out.texcoords) {
                    for (uint32_t c = 0; c < width; ++c) texcoords.set(t, row, c, out.texcoords + 2 * (to + c));
                }
            }
        }
        if (out.triangles)
            triangulate_tiles(surface, ws.triangulate, TileNumbers(GridNumbers{atlas, surface.side}), out.triangles);
    });
}

Status read_tile_seams(const LevelRequest& request, uint32_t* class_of, uint32_t* path_count) {
    if (class_of) return Status::kBadArgument;
    if (request.level >= request.header.level_count) return Status::kNoSuchLevel;
    std::span<const uint8_t> seams;
    if (Status s = read_seam_payload(request.header, request.file, &seams); s != Status::kOk) return s;
    if (path_count) *path_count = request.header.tiles.edges();
    return Status::kOk;
}

Status tile_domain_shape(const LevelRequest& request, DomainShape* shape, uint64_t* scratch_size) {
    gim_level_info info;
    if (Status s = tile_level_info(request, &info); s != Status::kOk) return s;
    const TileShape& tiles = request.header.tiles;
    if (request.finer > kMaxSideExponent) return Status::kLimitExceeded;
    const uint64_t side = uint64_t{tiles.intervals(request.level)} << request.finer;
    if (side > (uint64_t{1} << kMaxSideExponent)) return Status::kLimitExceeded;
    const uint64_t vertices = tiles.vertices + tiles.edges() * (side - 1) + tiles.tiles * (side - 1) * (side - 1);
    if (vertices > UINT32_MAX) return Status::kLimitExceeded;
    const auto slot = static_cast<uint32_t>(side + 1);
    *shape = {tiles.tiles, static_cast<uint32_t>(side), static_cast<uint32_t>(vertices),
              TileAtlas(tiles.tiles, static_cast<uint32_t>(side)).width() / slot, slot};
    Arena arena(nullptr);
    (void)lay_out_complex(tiles, &arena);
    *scratch_size = arena.used();
    return Status::kOk;
}

Status read_tile_glue(const LevelRequest& request, const DomainShape& shape, void* scratch, TileGlue* glue) {
    Arena arena(scratch);
    TileWorkspace ws = lay_out_complex(request.header.tiles, &arena);
    if (Status s = read_complex(request.header, request.file, ws); s != Status::kOk) return s;
    const QuadComplex& complex = ws.complex;
    const TileSamples samples(complex, shape.intervals);
    for (uint32_t h = 0; h < complex.half_edges(); ++h) {
        glue->mate[h] = complex.mate[h];
        glue->corner[h] = complex.vertex[h];
        glue->along[h] = shape.intervals > 1 ? samples.along(h, 1) : 0;
        glue->step[h] = complex.lower[complex.edge[h]] == h ? 1 : -1;
    }
    for (uint32_t t = 0; t < complex.tiles; ++t) glue->inner[t] = samples.inner(t);
    glue->row_step = shape.intervals - 1;
    return Status::kOk;
}

Status open_tile_plane(const LevelRequest& request, const Chunk& chunk, uint64_t offset, PlaneLevel* plane) {
    if (Status s = read_plane_chunk(request, chunk, offset, plane); s != Status::kOk) return s;
    plane->coarsest = texels_of(request, *plane);
    if (request.level > plane->coarsest) return Status::kNoSuchLevel;
    const AtlasTexels place(request, *plane);
    plane->width = place.width();
    plane->height = place.height();
    return Status::kOk;
}

uint64_t tile_plane_scratch_size(const LevelRequest& request, const PlaneLevel& plane) {
    Arena arena(nullptr);
    (void)lay_out_tiles(plane_shape(request, plane), request.level, &arena);
    return arena.used();
}

Status decode_tile_plane(const LevelRequest& request, const PlaneLevel& plane, void* scratch, float* values) {
    const TileShape shape = plane_shape(request, plane);
    Arena arena(scratch);
    TileWorkspace ws = lay_out_tiles(shape, request.level, &arena);
    if (Status s = read_complex(request.header, request.file, ws); s != Status::kOk) return s;
    float* samples = nullptr;
    if (Status s = decode_tile_samples(shape, plane.chunk, request.level, ws, &samples); s != Status::kOk) return s;
    AtlasTexels(request, plane).fill(samples, values);
    return Status::kOk;
}

}  // namespace gim

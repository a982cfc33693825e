#include "decoder/charts/read_charts.h"

#include <algorithm>
#include <limits>

#include "decoder/charts/chart_surface.h"
#include "format/chart_table.h"

namespace gim {
namespace {

// One level, decoded.
struct Surface {
    ChartLevelShape shape;
    ChartWorkspace ws;
    const float* samples = nullptr;  // units
};

uint64_t scratch_size(const ChartLevelShape& shape) {
    Arena arena(nullptr);
    (void)lay_out_charts(shape, &arena);
    return arena.used();
}

PyramidWorkspace lay_out_plane(const PlaneLevel& plane, Arena* arena) {
    PyramidWorkspace ws;
    lay_out_coder(plane.width, arena, &ws);
    lay_out_samples(plane.width, plane.height, arena, &ws);
    return ws;
}

// Sets the texture coordinates, in the rectangle, of a sample of the box at full resolution.
void set_texcoords(const Header& header, const ChartBox& box, uint32_t column, uint32_t row, float* uv) {
    uv[0] = static_cast<float>(box.atlas_column + static_cast<int32_t>(column)) / static_cast<float>(header.width - 1);
    uv[1] = static_cast<float>(box.atlas_row + static_cast<int32_t>(row)) / static_cast<float>(header.height - 1);
}

// Boxes may lie partly outside of the grid, but defined samples may not.
bool lie_in_grid(const ChartLevelShape& shape, const ChartWorkspace& ws) {
    for (uint32_t c = 0; c < shape.chart_count; ++c) {
        const DecodedChart& chart = ws.charts[c];
        for (uint32_t k = 0; k < chart.border.border_length; ++k) {  // inner samples lie between these
            const uint32_t i = chart.border.samples[k];
            if (chart.grid_column + i % chart.columns >= shape.columns ||
                chart.grid_row + i / chart.columns >= shape.rows)
                return false;
        }
    }
    return true;
}

Status decode(const LevelRequest& request, const Memory& scratch, Surface* surface) {
    if (Status s = open_charts(request.header, request.file, request.limits, request.level, &surface->shape);
        s != Status::kOk)
        return s;
    if (Status s = check_scratch(scratch, scratch_size(surface->shape)); s != Status::kOk) return s;
    Arena arena(scratch.bytes);
    surface->ws = lay_out_charts(surface->shape, &arena);
    if (Status s =
            decode_charts(request.header, request.file, request.limits, surface->shape, surface->ws, &surface->samples);
        s != Status::kOk)
        return s;
    return lie_in_grid(surface->shape, surface->ws) ? Status::kOk : Status::kMalformed;
}

}  // namespace

Status chart_level_info(const LevelRequest& request, gim_level_info* info) {
    ChartLevelShape shape;
    if (Status s = open_charts(request.header, request.file, request.limits, request.level, &shape); s != Status::kOk)
        return s;
    Chunk chunk;
    uint64_t offset = 0;
    if (Status s = find_level_chunk(request.header, request.level, &chunk, &offset); s != Status::kOk) return s;
    *info = {};
    info->width = shape.columns;
    info->height = shape.rows;
    info->coarsest_level = request.header.level_count - 1;
    info->vertex_count = shape.size.vertices;
    info->triangle_count = shape.size.triangles;
    info->prefix_size = offset + chunk.size;
    info->scratch_size = scratch_size(shape);
    return Status::kOk;
}

Status read_chart_seams(const LevelRequest& request, uint32_t* class_of, uint32_t* path_count) {
    if (class_of) return Status::kBadArgument;
    ChartLevelShape shape;
    if (Status s = open_charts(request.header, request.file, request.limits, request.level, &shape); s != Status::kOk)
        return s;
    if (path_count) *path_count = shape.path_count;
    return Status::kOk;
}

Status decode_chart_mesh(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch) {
    Surface surface;
    if (Status s = decode(request, scratch, &surface); s != Status::kOk) return s;
    const Header& header = request.header;
    const uint32_t level = request.level;
    const ChartLevelShape& shape = surface.shape;
    for_each_chart_run(shape, surface.ws, [&](uint32_t v, size_t sample, size_t count) {
        to_object(header.origin, header.step, surface.samples + sample * 3, out.positions + size_t{v} * 3, count);
    });
    if (out.texcoords) {
        for_each_chart_vertex(
            shape, surface.ws, [&](uint32_t v, const DecodedChart& chart, uint32_t column, uint32_t row, uint32_t) {
                set_texcoords(header, chart.box, column << level, row << level, out.texcoords + size_t{v} * 2);
            });
    }
    const ChartTriangles triangles = {surface.ws.point, out.triangles, out.normals};
    return triangulate_charts(shape, surface.ws, surface.samples, triangles) ? Status::kOk : Status::kMalformed;
}

Status decode_chart_grid(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch) {
    Surface surface;
    if (Status s = decode(request, scratch, &surface); s != Status::kOk) return s;
    const Header& header = request.header;
    const uint32_t level = request.level;
    const ChartLevelShape& shape = surface.shape;
    const size_t count = size_t{shape.columns} * shape.rows * 3;
    std::fill_n(out.positions, count, std::numeric_limits<float>::quiet_NaN());
    if (out.normals) std::fill_n(out.normals, count, 0.0f);
    if (out.texcoords) std::fill_n(out.texcoords, count / 3 * 2, 0.0f);
    // Places in the grid of flat samples, and normals of vertices, lie where nothing is needed any more.
    uint32_t* place = surface.ws.queue;
    float* vertex_normals = out.normals ? surface.ws.sums : nullptr;
    for (uint32_t c = 0; c < shape.chart_count; ++c) {
        const DecodedChart& chart = surface.ws.charts[c];
        for (uint32_t i = 0; i < chart.columns * chart.rows; ++i) {
            const uint32_t sample = chart.first + i;
            if (surface.ws.depth[sample] == kUndefined) continue;
            const uint32_t column = chart.grid_column + i % chart.columns, row = chart.grid_row + i / chart.columns;
            place[sample] = row * shape.columns + column;
            to_object(header.origin, header.step, surface.samples + size_t{sample} * 3,
                      out.positions + size_t{place[sample]} * 3);
            if (out.texcoords)
                set_texcoords(header, chart.box, (i % chart.columns) << level, (i / chart.columns) << level,
                              out.texcoords + size_t{place[sample]} * 2);
        }
    }
    const ChartTriangles triangles = {place, out.triangles, vertex_normals};
    if (!triangulate_charts(shape, surface.ws, surface.samples, triangles)) return Status::kMalformed;
    for (uint32_t sample = 0; out.normals && sample < shape.samples; ++sample) {
        if (surface.ws.depth[sample] == kUndefined) continue;
        std::copy_n(vertex_normals + size_t{surface.ws.point[sample]} * 3, 3, out.normals + size_t{place[sample]} * 3);
    }
    return Status::kOk;
}

Status open_chart_plane(const LevelRequest& request, const Chunk& chunk, uint64_t offset, PlaneLevel* plane) {
    if (Status s = read_plane_chunk(request, chunk, offset, plane); s != Status::kOk) return s;
    const uint32_t exponent = plane->chunk.side_exponents[request.image];
    const auto width = static_cast<uint32_t>(texels_along(request.header.width, exponent)),
               height = static_cast<uint32_t>(texels_along(request.header.height, exponent));
    plane->coarsest = halvings(width, height);
    if (request.level > plane->coarsest) return Status::kNoSuchLevel;
    plane->width = halved(width, request.level);
    plane->height = halved(height, request.level);
    plane->shape = {width, height, plane->coarsest, request.level, {plane->chunk.quantizer}, 0, false};
    return Status::kOk;
}

uint64_t chart_plane_scratch_size(const LevelRequest&, const PlaneLevel& plane) {
    Arena arena(nullptr);
    (void)lay_out_plane(plane, &arena);
    return arena.used();
}

Status decode_chart_plane(const LevelRequest&, const PlaneLevel& plane, void* scratch, float* values) {
    Arena arena(scratch);
    return decode_pyramid_plane(plane, lay_out_plane(plane, &arena), values);
}

}  // namespace gim

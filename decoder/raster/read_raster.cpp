#include "decoder/raster/read_raster.h"

#include <algorithm>
#include <limits>

#include "decoder/charts/chart_surface.h"

namespace gim {
namespace {

// The positions, as one chart that fills the rectangle.
struct Surface {
    OpenRaster raster;
    RasterShape grid;
    RasterWork work;
    ChartLevelShape shape;
    ChartWorkspace ws;
    float* samples = nullptr;  // units

    Status open(const LevelRequest& request) {
        if (Status s = open_raster(request, &raster); s != Status::kOk) return s;
        grid = {request.header.width, request.header.height, kRasterGroup};
        shape.chart_count = 1;
        shape.columns = grid.columns;
        shape.rows = grid.rows;
        shape.size = {raster.table.vertices, raster.table.triangles};
        return Status::kOk;
    }
    void lay_out(Arena* arena) {
        work = lay_out_raster(grid, arena);
        work.values = arena->take<int32_t>(grid.samples() * grid.channels);
        ws.charts = arena->take<DecodedChart>(1);
        ws.depth = work.depth;
        ws.point = work.point;
        samples = arena->take<float>(grid.samples() * 3);
    }
    uint64_t scratch_size() const {
        Surface counted = *this;
        Arena arena(nullptr);
        counted.lay_out(&arena);
        return arena.used();
    }
    Status decode(const LevelRequest& request, const Memory& scratch) {
        if (Status s = open(request); s != Status::kOk) return s;
        if (Status s = check_scratch(scratch, scratch_size()); s != Status::kOk) return s;
        Arena arena(scratch.bytes);
        lay_out(&arena);
        if (Status s = decode_raster(request, raster, grid, work); s != Status::kOk) return s;
        ws.charts[0] = {};
        ws.charts[0].columns = grid.columns;
        ws.charts[0].rows = grid.rows;
        const float unit = request.header.coding == Coding::kLossy ? request.header.quantizer : 1.0f;
        for (size_t i = 0; i < grid.samples(); ++i) {
            for (size_t k = 3 * i; k < 3 * i + 3; ++k)
                samples[k] = work.depth[i] == kUndefined ? 0.0f : unit * static_cast<float>(work.values[k]);
        }
        return Status::kOk;
    }
    Status triangulate(const ChartTriangles& out) const {
        return triangulate_charts(shape, ws, samples, out) ? Status::kOk : Status::kMalformed;
    }
    void set_texcoords(uint32_t sample, float* uv) const {
        uv[0] = static_cast<float>(sample % grid.columns) / static_cast<float>(grid.columns - 1);
        uv[1] = static_cast<float>(sample / grid.columns) / static_cast<float>(grid.rows - 1);
    }
};

RasterShape whole_shape(const LevelRequest& request, const OpenRaster& raster) {
    return {request.header.width, request.header.height, raster.table.channels};
}

}  // namespace

Status raster_level_info(const LevelRequest& request, gim_level_info* info) {
    Surface surface;
    if (Status s = surface.open(request); s != Status::kOk) return s;
    *info = {};
    info->width = surface.grid.columns;
    info->height = surface.grid.rows;
    info->vertex_count = surface.shape.size.vertices;
    info->triangle_count = surface.shape.size.triangles;
    info->prefix_size = surface.raster.prefix;
    info->scratch_size = surface.scratch_size();
    return Status::kOk;
}

Status read_raster_seams(const LevelRequest& request, uint32_t* class_of, uint32_t* path_count) {
    if (class_of) return Status::kBadArgument;
    OpenRaster raster;
    if (Status s = open_raster(request, &raster); s != Status::kOk) return s;
    if (path_count) *path_count = 0;
    return Status::kOk;
}

Status decode_raster_mesh(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch) {
    Surface surface;
    if (Status s = surface.decode(request, scratch); s != Status::kOk) return s;
    for_each_chart_vertex(surface.shape, surface.ws,
                          [&](uint32_t v, const DecodedChart&, uint32_t, uint32_t, uint32_t sample) {
                              to_object(request.header.origin, request.header.step,
                                        surface.samples + size_t{sample} * 3, out.positions + size_t{v} * 3);
                              if (out.texcoords) surface.set_texcoords(sample, out.texcoords + size_t{v} * 2);
                          });
    return surface.triangulate({surface.work.point, out.triangles, out.normals});
}

Status decode_raster_grid(const LevelRequest& request, const SurfaceArrays& out, const Memory& scratch) {
    Surface surface;
    if (Status s = surface.decode(request, scratch); s != Status::kOk) return s;
    // Normals of vertices lie where the values were, which take as much room or more.
    float* vertex_normals = out.normals ? static_cast<float*>(static_cast<void*>(surface.work.values)) : nullptr;
    if (Status s = surface.triangulate({nullptr, out.triangles, vertex_normals}); s != Status::kOk) return s;
    for (uint32_t i = 0; i < surface.grid.samples(); ++i) {
        const bool is_defined = surface.work.depth[i] != kUndefined;
        float* position = out.positions + size_t{i} * 3;
        std::fill_n(position, 3, std::numeric_limits<float>::quiet_NaN());
        if (is_defined)
            to_object(request.header.origin, request.header.step, surface.samples + size_t{i} * 3, position);
        if (out.texcoords) {
            std::fill_n(out.texcoords + size_t{i} * 2, 2, 0.0f);
            if (is_defined) surface.set_texcoords(i, out.texcoords + size_t{i} * 2);
        }
        if (out.normals) {
            float* normal = out.normals + size_t{i} * 3;
            std::fill_n(normal, 3, 0.0f);
            if (is_defined) std::copy_n(vertex_normals + size_t{surface.work.point[i]} * 3, 3, normal);
        }
    }
    return Status::kOk;
}

Status open_raster_plane(const LevelRequest&, const Chunk&, uint64_t, PlaneLevel*) { return Status::kNoSuchPlane; }
uint64_t raster_plane_scratch_size(const LevelRequest&, const PlaneLevel&) { return 0; }
Status decode_raster_plane(const LevelRequest&, const PlaneLevel&, void*, float*) { return Status::kNoSuchPlane; }

Status raster_info(const LevelRequest& request, gim_raster_info* info) {
    OpenRaster raster;
    if (Status s = open_raster(request, &raster); s != Status::kOk) return s;
    const RasterTable& table = raster.table;
    *info = {};
    info->width = request.header.width;
    info->height = request.header.height;
    info->channels = table.channels;
    info->sample_type = table.sample_type;
    info->is_channels_first = table.is_channels_first ? 1 : 0;
    info->mask = table.mask;
    info->mask_value = table.mask_value;
    info->prefix_size = raster.prefix;
    Arena arena(nullptr);
    (void)lay_out_raster(whole_shape(request, raster), &arena);
    info->scratch_size = arena.used();
    return Status::kOk;
}

Status raster_channel(const LevelRequest& request, uint32_t index, gim_raster_channel* channel) {
    OpenRaster raster;
    if (Status s = open_raster(request, &raster); s != Status::kOk) return s;
    if (index >= raster.table.channels) return Status::kBadArgument;
    const Header& header = request.header;
    if (index >= kRasterGroup) {
        const RasterChannel told = raster.table.channel(index);
        *channel = {told.bits, double{told.origin}, double{told.step}};
        return Status::kOk;
    }
    const double unit = header.coding == Coding::kLossy ? double{header.quantizer} : 1.0;
    *channel = {header.bits, header.wide_origin ? (*header.wide_origin)[index] : double{header.origin[index]},
                double{header.step} * unit};
    return Status::kOk;
}

Status decode_raster_values(const LevelRequest& request, int32_t* values, uint8_t* mask, const Memory& scratch) {
    OpenRaster raster;
    if (Status s = open_raster(request, &raster); s != Status::kOk) return s;
    const RasterShape shape = whole_shape(request, raster);
    Arena counted(nullptr), arena(scratch.bytes);
    (void)lay_out_raster(shape, &counted);
    if (Status s = check_scratch(scratch, counted.used()); s != Status::kOk) return s;
    RasterWork work = lay_out_raster(shape, &arena);
    work.values = values;
    if (Status s = decode_raster(request, raster, shape, work); s != Status::kOk) return s;
    for (size_t i = 0; i < shape.samples(); ++i) {
        mask[i] = work.depth[i] != kUndefined ? 1 : 0;
        if (mask[i] == 0) std::fill_n(values + i * shape.channels, shape.channels, 0);
    }
    return Status::kOk;
}

}  // namespace gim

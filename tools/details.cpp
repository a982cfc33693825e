#include "tools/details.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "gim/refine.h"

namespace gim {
namespace {

constexpr uint32_t kMostTriangles = 1u << 24;
constexpr float kErrorOfDepth = 0.01f;  // what is left out, as a share of the largest displacement

// An open domain with details, and what it stands on.
struct DetailedSurface {
    gim_domain_info shape{};
    DecoderPlane plane{};
    uint32_t parts = 1;                  // texels for each step between samples of level 0
    uint32_t slot = 0, coarse_slot = 0;  // samples from one tile to the next, here and at level 0
    std::vector<float> displacements, positions;
    Scratch memory, of_mesh;
    const gim_domain* domain = nullptr;
    gim_refined* mesh = nullptr;

    uint32_t tile_columns() const { return shape.width / slot; }
    // The place of a sample of a tile in the image, and of its texel in the plane.
    size_t sample(uint32_t tile, uint32_t row, uint32_t column) const {
        return (size_t{tile / tile_columns()} * slot + row) * shape.width + tile % tile_columns() * slot + column;
    }
    size_t texel(uint32_t tile, uint32_t row, uint32_t column) const {
        const size_t y = size_t{tile / tile_columns() * coarse_slot} * parts + row;
        return y * plane.width + size_t{tile % tile_columns() * coarse_slot} * parts + column;
    }
    // How far the sample is displaced.
    float displacement(uint32_t tile, uint32_t row, uint32_t column) const {
        const float* by = &displacements[3 * texel(tile, row, column)];
        return std::sqrt(by[0] * by[0] + by[1] * by[1] + by[2] * by[2]);
    }
};

gim_status open(Decoder& decoder, const Bytes& file, const DecodedImage& image, DetailedSurface* d) {
    const gim_info& info = decoder.info();
    d->displacements.resize(3 * size_t{d->plane.width} * d->plane.height);
    gim_status status = decoder.plane(d->plane, d->displacements);
    if (status != GIM_OK) return status;
    const uint32_t index = d->plane.image;
    status = gim_read_detailed_domain_info(&info, file.data(), file.size(), index, 0, &d->shape);
    if (status != GIM_OK) return status;
    d->parts = (d->plane.width - 1) / (image.columns - 1);
    // The tiles of a square share the samples of their sides.
    const uint32_t apart = info.layout == GIM_LAYOUT_TILES ? 1 : 0;
    d->slot = d->shape.intervals + apart;
    d->coarse_slot = d->shape.intervals / d->parts + apart;
    d->positions.resize(3 * size_t{d->shape.vertex_count});
    d->memory = Scratch(d->shape.domain_size);
    Scratch scratch(d->shape.scratch_size);
    status = gim_open_detailed_domain(&info, file.data(), file.size(), index, 0, image.positions.data(),
                                      d->displacements.data(), d->positions.data(), d->memory.data(), d->memory.size(),
                                      scratch.data(), scratch.size(), &d->domain);
    if (status != GIM_OK) return status;
    const auto most = static_cast<uint32_t>(std::min<uint64_t>(d->shape.most_triangles, kMostTriangles));
    d->of_mesh = Scratch(gim_refined_size(d->domain, most));
    return gim_begin_refined(d->domain, most, d->of_mesh.data(), d->of_mesh.size(), &d->mesh);
}

// Which vertices the mesh needs: all samples of level 0, and those whose absence would show in the details.
struct Needs {
    std::vector<bool> is_sample, is_near;  // per vertex; near: in a cell of level 0 where something is displaced
    float error = 0;                       // what may be left out

    static float need(void* user, uint32_t vertex, const float*, float error, float) {
        const auto& n = *static_cast<const Needs*>(user);
        if (n.is_sample[vertex]) return 2;
        return n.is_near[vertex] ? error / n.error : 0;
    }
};

// Calls f(vertex, row, column) for the samples of the cell of level 0 whose first sample is at (row, column) of the tile.
template <class F>
void for_each_in_cell(const DetailedSurface& d, const std::vector<uint32_t>& vertex_at, uint32_t tile, uint32_t row,
                      uint32_t column, const F& f) {
    for (uint32_t r = row; r <= row + d.parts; ++r) {
        for (uint32_t c = column; c <= column + d.parts; ++c) f(vertex_at[d.sample(tile, r, c)], r, c);
    }
}

float largest_displacement(const DetailedSurface& d) {
    float largest = 0;
    for (size_t i = 0; i < d.displacements.size(); i += 3) {
        const float* by = &d.displacements[i];
        largest = std::max(largest, by[0] * by[0] + by[1] * by[1] + by[2] * by[2]);
    }
    return std::sqrt(largest);
}

Needs needs_of(const DetailedSurface& d) {
    Needs needs;
    needs.is_sample.resize(d.shape.vertex_count, false);
    needs.is_near.resize(d.shape.vertex_count, false);
    std::vector<uint32_t> vertex_at(size_t{d.shape.width} * d.shape.height);
    gim_read_sample_vertices(d.domain, vertex_at.data());
    const uint32_t cells = d.shape.intervals / d.parts;
    // The lossy code leaves next to nothing far around what was displaced: it is not worth a triangle.
    needs.error = std::max(kErrorOfDepth * largest_displacement(d), std::numeric_limits<float>::min());
    for (uint32_t t = 0; t < d.shape.tile_count; ++t) {
        for (uint32_t cell = 0; cell < cells * cells; ++cell) {
            const uint32_t row = cell / cells * d.parts, column = cell % cells * d.parts;
            float most = 0;
            for_each_in_cell(d, vertex_at, t, row, column, [&](uint32_t v, uint32_t r, uint32_t c) {
                if (r % d.parts == 0 && c % d.parts == 0) needs.is_sample[v] = true;
                most = std::max(most, d.displacement(t, r, c));
            });
            if (most <= needs.error) continue;
            for_each_in_cell(d, vertex_at, t, row, column,
                             [&](uint32_t v, uint32_t, uint32_t) { needs.is_near[v] = true; });
        }
    }
    return needs;
}

void add_normal(const float* a, const float* b, const float* c, float* const (&sums)[3]) {
    const float u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const float n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    for (float* sum : sums)
        for (size_t k = 0; k < 3; ++k) sum[k] += n[k];
}

// Turns the refined mesh into the surface of the image.
void take_surface(const DetailedSurface& d, DecodedImage* image) {
    uint32_t count = 0;
    const uint32_t* triangles = gim_refined_triangles(d.mesh, &count);
    const std::vector<float> normals = vertex_normals(d.positions, {triangles, 3 * size_t{count}});
    const size_t samples = size_t{d.shape.width} * d.shape.height;
    DecodedImage out;
    out.origin = image->origin;
    out.normal_map = std::move(image->normal_map);
    out.colors = std::move(image->colors);
    out.columns = d.shape.width;
    out.rows = d.shape.height;
    out.grid.assign(3 * samples, std::numeric_limits<float>::quiet_NaN());
    out.grid_normals.assign(3 * samples, 0.0f);
    out.grid_texcoords.assign(2 * samples, 0.0f);
    std::vector<uint32_t> number(d.shape.vertex_count, UINT32_MAX);
    for (uint32_t h = 0; h < 3 * count; ++h) {
        gim_half_edge edge;
        (void)gim_read_half_edge(d.mesh, h, &edge);
        const size_t sample = d.sample(edge.tile, edge.start[0], edge.start[1]), v = edge.vertex;
        const size_t texel = d.texel(edge.tile, edge.start[0], edge.start[1]);
        const float uv[2] = {static_cast<float>(texel % d.plane.width) / static_cast<float>(d.plane.width - 1),
                             static_cast<float>(texel / d.plane.width) / static_cast<float>(d.plane.height - 1)};
        std::copy_n(&d.positions[3 * v], 3, &out.grid[3 * sample]);
        std::copy_n(&normals[3 * v], 3, &out.grid_normals[3 * sample]);
        std::copy_n(uv, 2, &out.grid_texcoords[2 * sample]);
        if (number[v] == UINT32_MAX) {
            number[v] = static_cast<uint32_t>(out.positions.size() / 3);
            out.positions.insert(out.positions.end(), &d.positions[3 * v], &d.positions[3 * v] + 3);
            out.normals.insert(out.normals.end(), &normals[3 * v], &normals[3 * v] + 3);
            out.texcoords.insert(out.texcoords.end(), uv, uv + 2);
        }
        out.grid_triangles.push_back(static_cast<uint32_t>(sample));
        out.triangles.push_back(number[v]);
    }
    *image = std::move(out);
}

}  // namespace

std::vector<float> vertex_normals(std::span<const float> positions, std::span<const uint32_t> triangles) {
    std::vector<float> normals(positions.size(), 0.0f);
    const auto at = [](auto& of, uint32_t v) { return &of[3 * size_t{v}]; };
    for (size_t i = 0; i < triangles.size(); i += 3) {
        const uint32_t* t = &triangles[i];
        add_normal(at(positions, t[0]), at(positions, t[1]), at(positions, t[2]),
                   {at(normals, t[0]), at(normals, t[1]), at(normals, t[2])});
    }
    for (size_t i = 0; i < normals.size(); i += 3) {
        const float length =
            std::sqrt(normals[i] * normals[i] + normals[i + 1] * normals[i + 1] + normals[i + 2] * normals[i + 2]);
        for (size_t k = 0; k < 3; ++k) normals[i + k] = length > 0 ? normals[i + k] / length : 0;
    }
    return normals;
}

gim_status add_details(Decoder& decoder, const Bytes& file, uint32_t index, DecodedImage* image) {
    DetailedSurface d;
    gim_status status = decoder.read_plane(index, GIM_PLANE_DISPLACEMENTS, 0, &d.plane);
    if (status == GIM_NO_SUCH_PLANE || decoder.info().layout == GIM_LAYOUT_MCGIM) return GIM_OK;
    if (status != GIM_OK) return status;
    status = open(decoder, file, *image, &d);
    if (status != GIM_OK) return status;
    Needs needs = needs_of(d);
    gim_rule rule{};
    rule.need = Needs::need;
    rule.user = &needs;
    status = gim_refine(d.mesh, &rule, 0, nullptr);
    if (status == GIM_OK) take_surface(d, image);
    return status;
}

}  // namespace gim

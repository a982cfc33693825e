// What the JavaScript of gim/refine calls besides gim/refine.h and gim/clusters.h: records as rows of numbers, as in
// calls.cpp. decoder/bindings/npm/refine_*.js read them in the same order. `row`: room for 64 numbers.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "gim/clusters.h"

// Of the page, for gim_js_refine.
extern "C" __attribute__((import_module("gim"), import_name("need"))) float gim_js_need(uint32_t vertex, float x,
                                                                                        float y, float z, float error,
                                                                                        float radius);

namespace {

template <class... Numbers>
void fill(double* row, Numbers... numbers) {
    ((*row++ = static_cast<double>(numbers)), ...);
}

double address(const void* at) { return static_cast<double>(reinterpret_cast<uintptr_t>(at)); }

gim_status told(gim_status status, const gim_domain_info& shape, double* row) {
    if (status == GIM_OK)
        fill(row, shape.tile_count, shape.intervals, shape.vertex_count, shape.most_triangles, shape.domain_size,
             shape.scratch_size, shape.width, shape.height);
    return status;
}

float ask(void*, uint32_t vertex, const float* position, float error, float radius) {
    return gim_js_need(vertex, position[0], position[1], position[2], error, radius);
}

}  // namespace

extern "C" {

gim_status gim_js_domain(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                         double* row) {
    gim_domain_info shape;
    return told(gim_read_domain_info(info, bytes, size, image, level, &shape), shape, row);
}

gim_status gim_js_detailed_domain(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                  uint32_t plane_level, double* row) {
    gim_domain_info shape;
    return told(gim_read_detailed_domain_info(info, bytes, size, image, plane_level, &shape), shape, row);
}

double gim_js_refined_size(const gim_domain* domain, uint32_t most_triangles) {
    return static_cast<double>(gim_refined_size(domain, most_triangles));
}

// row: what a gim_rule has, but for the planes. planes: plane_count times four numbers.
gim_status gim_js_refine(gim_refined* mesh, const double* row, const float* planes, uint32_t plane_count,
                         uint32_t has_need, uint32_t most_operations, uint32_t* done) {
    gim_rule rule{};
    const auto next = [&row] { return static_cast<float>(*row++); };
    const auto next_of = [&next](float* to, size_t count) { std::generate_n(to, count, next); };
    rule.pixel_error = next();
    next_of(rule.eye, 3);
    rule.pixels_per_unit = next();
    rule.object_error = next();
    next_of(rule.box, 6);
    next_of(rule.sphere, 4);
    rule.keep = next();
    rule.most_triangles = static_cast<uint32_t>(*row);
    rule.planes = planes;
    rule.plane_count = plane_count;
    if (has_need) rule.need = ask;
    return gim_refine(mesh, &rule, most_operations, done);
}

void gim_js_changes(gim_refined* mesh, double* row) {
    gim_changes c;
    gim_take_changes(mesh, &c);
    fill(row, address(c.added), c.added_count, address(c.removed), c.removed_count, address(c.triangles),
         c.changed_count, c.triangles_before, c.triangle_count);
}

gim_status gim_js_half_edge(const gim_refined* mesh, uint32_t half_edge, double* row) {
    gim_half_edge h;
    const gim_status status = gim_read_half_edge(mesh, half_edge, &h);
    if (status == GIM_OK) fill(row, h.mate, h.vertex, h.tile, h.start[0], h.start[1], h.end[0], h.end[1], h.level);
    return status;
}

gim_status gim_js_cluster_sizes(const gim_domain* domain, uint32_t side, double* row) {
    gim_cluster_sizes sizes;
    const gim_status status = gim_read_cluster_sizes(domain, side, &sizes);
    if (status == GIM_OK)
        fill(row, sizes.cluster_count, sizes.vertex_count, sizes.triangle_count, sizes.scratch_size,
             sizeof(gim_cluster));
    return status;
}

// depths: room for 7 numbers for each of GIM_MAX_CLUSTER_DEPTHS.
gim_status gim_js_clusters(const gim_domain* domain, uint32_t side, gim_cluster* clusters, uint32_t* vertices,
                           uint8_t* triangles, void* scratch, size_t scratch_size, double* row, double* depths) {
    gim_cluster_tree tree;
    const gim_status status =
        gim_decode_clusters(domain, side, clusters, vertices, triangles, scratch, scratch_size, &tree);
    if (status != GIM_OK) return status;
    fill(row, tree.cluster_count, tree.vertex_count, tree.triangle_count, tree.depth_count, tree.mesh_depth_count);
    for (const gim_cluster_depth* d = tree.depths; d != tree.depths + tree.depth_count; ++d, depths += 7)
        fill(depths, d->first_cluster, d->cluster_count, d->first_vertex, d->vertex_count, d->first_triangle,
             d->triangle_count, d->error);
    return status;
}

// Takes clusters apart. spheres: 4 numbers each; cones: 8; errors: 2; links: 4; ranges: 4.
void gim_js_split_clusters(const gim_cluster* clusters, uint32_t count, float* spheres, float* cones, float* errors,
                           uint32_t* links, uint32_t* ranges) {
    for (const gim_cluster* c = clusters; c != clusters + count; ++c) {
        spheres = std::copy_n(c->center, 3, spheres);
        *spheres++ = c->radius;
        cones = std::copy_n(c->cone_apex, 3, cones);
        *cones++ = c->cone_cutoff;
        cones = std::copy_n(c->cone_axis, 3, cones);
        *cones++ = 0;
        for (const float error : {c->error, c->parent_error}) *errors++ = error;
        for (const uint32_t link : {c->parent, c->first_child, c->child_count, c->depth}) *links++ = link;
        for (const uint32_t end : {c->first_vertex, c->vertex_count, c->first_triangle, c->triangle_count})
            *ranges++ = end;
    }
}
}

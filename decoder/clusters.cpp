// The C interface of gim/clusters.h.
#include "gim/clusters.h"

#include <algorithm>
#include <cstdint>

#include "decoder/layout/level_reader.h"
#include "decoder/open_domain.h"
#include "decoder/refine/cluster_builder.h"

using namespace gim;

gim_status gim_read_cluster_sizes(const gim_domain* domain, uint32_t side, gim_cluster_sizes* sizes) {
    if (!domain || !sizes || (side != 4 && side != 8)) return GIM_BAD_ARGUMENT;
    const Status status = ClusterBuilder::read_sizes(domain->domain.shape(), side, sizes);
    if (status != Status::kOk) return static_cast<gim_status>(status);
    Arena arena(nullptr);
    (void)ClusterBuilder(&domain->domain, side, &arena);
    sizes->scratch_size = arena.used();
    return GIM_OK;
}

gim_status gim_decode_clusters(const gim_domain* domain, uint32_t side, gim_cluster* clusters, uint32_t* vertices,
                               uint8_t* triangles, void* scratch, size_t scratch_size, gim_cluster_tree* tree) {
    if (!clusters || !vertices || !triangles || !tree) return GIM_BAD_ARGUMENT;
    gim_cluster_sizes sizes;
    if (gim_status s = gim_read_cluster_sizes(domain, side, &sizes); s != GIM_OK) return s;
    if (Status s = check_scratch({scratch, scratch_size}, sizes.scratch_size); s != Status::kOk)
        return static_cast<gim_status>(s);
    Arena arena(scratch);
    ClusterBuilder(&domain->domain, side, &arena).run({clusters, vertices, triangles}, tree);
    return GIM_OK;
}

void gim_read_cluster_triangles(const gim_cluster* clusters, uint32_t cluster_count, const uint32_t* vertices,
                                const uint8_t* triangles, uint32_t* indices) {
    for (const gim_cluster* cluster = clusters; cluster != clusters + cluster_count; ++cluster) {
        const uint8_t* const local = triangles + 3 * size_t{cluster->first_triangle};
        for (size_t i = 0; i < 3 * size_t{cluster->triangle_count}; ++i)
            *indices++ = vertices[cluster->first_vertex + local[i]];
    }
}

gim_status gim_count_cache_misses(const uint32_t* triangles, uint32_t triangle_count, uint32_t vertex_count,
                                  uint32_t cache_size, uint32_t* scratch, gim_cache_statistics* statistics) {
    constexpr uint32_t kMostSize = 1u << 30;
    if (!statistics || cache_size == 0 || cache_size > kMostSize) return GIM_BAD_ARGUMENT;
    if ((!triangles && triangle_count > 0) || (!scratch && vertex_count > 0)) return GIM_BAD_ARGUMENT;
    if (triangle_count > UINT32_MAX / 3) return GIM_LIMIT_EXCEEDED;
    // Per vertex: the number of misses up to its own last one; 0 before the first one.
    std::fill_n(scratch, vertex_count, 0u);
    uint32_t misses = 0, used = 0;
    for (size_t i = 0; i < 3 * size_t{triangle_count}; ++i) {
        if (triangles[i] >= vertex_count) return GIM_BAD_ARGUMENT;
        uint32_t& last = scratch[triangles[i]];
        if (last != 0 && misses - last < cache_size) continue;
        used += last == 0;
        last = ++misses;
    }
    statistics->misses = misses;
    statistics->acmr = triangle_count > 0 ? static_cast<float>(static_cast<double>(misses) / triangle_count) : 0;
    statistics->atvr = used > 0 ? static_cast<float>(static_cast<double>(misses) / used) : 0;
    return GIM_OK;
}

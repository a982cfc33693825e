#include "tools/cluster_report.h"

#include <algorithm>
#include <cstdio>

#include "gim/clusters.h"
#include "gim/decoder.hpp"

namespace gim {
namespace {

constexpr uint32_t kSide = 8, kCacheSize = 16;

// A decoded image with its domain, and all memory that belongs to it.
struct OpenDomain {
    std::vector<float> positions;
    Scratch memory, scratch;
    const gim_domain* domain = nullptr;
    uint32_t vertex_count = 0;

    gim_status open(const gim_info& info, std::span<const uint8_t> file, uint32_t image) {
        const void* const bytes = file.data();
        gim_level_info level;
        gim_domain_info shape;
        gim_status status = gim_read_domain_info(&info, bytes, file.size(), image, 0, &shape);
        if (status == GIM_OK) status = gim_read_level_info(&info, bytes, file.size(), image, 0, &level);
        if (status != GIM_OK) return status;
        if (!scratch.reserve(std::max(level.scratch_size, shape.scratch_size)) || !memory.reserve(shape.domain_size))
            return GIM_SCRATCH_TOO_SMALL;
        vertex_count = shape.vertex_count;
        positions.resize(3 * size_t{vertex_count});
        status = gim_decode_mesh(&info, bytes, file.size(), image, 0, positions.data(), nullptr, nullptr, nullptr,
                                 scratch.data(), scratch.size());
        if (status != GIM_OK) return status;
        return gim_open_domain(&info, bytes, file.size(), image, 0, positions.data(), memory.data(), memory.size(),
                               scratch.data(), scratch.size(), &domain);
    }
};

// Seen from far away, so that only the axis of the cone matters.
double culled_share(const gim_cluster* clusters, uint32_t count, uint32_t triangles) {
    double culled = 0;
    for (const gim_cluster* c = clusters; c != clusters + count; ++c) {
        for (const float along : c->cone_axis) {
            for (const float cosine : {along, -along}) culled += cosine >= c->cone_cutoff ? c->triangle_count : 0;
        }
    }
    return culled / (6.0 * triangles);
}

}  // namespace

gim_status measure_clusters(const gim_info& info, std::span<const uint8_t> file, uint32_t image,
                            std::vector<ClusterFigures>* figures) {
    OpenDomain open;
    if (const gim_status status = open.open(info, file, image); status != GIM_OK) return status;
    gim_cluster_sizes sizes;
    if (const gim_status status = gim_read_cluster_sizes(open.domain, kSide, &sizes); status != GIM_OK) return status;
    std::vector<gim_cluster> clusters(sizes.cluster_count);
    std::vector<uint32_t> vertices(sizes.vertex_count);
    std::vector<uint8_t> triangles(3 * size_t{sizes.triangle_count});
    Scratch scratch;
    if (!scratch.reserve(sizes.scratch_size)) return GIM_SCRATCH_TOO_SMALL;
    gim_cluster_tree tree;
    const gim_status status = gim_decode_clusters(open.domain, kSide, clusters.data(), vertices.data(),
                                                  triangles.data(), scratch.data(), scratch.size(), &tree);
    if (status != GIM_OK) return status;

    std::vector<uint32_t> indices, work(open.vertex_count);
    for (uint32_t depth = 0; depth < tree.mesh_depth_count; ++depth) {
        const gim_cluster_depth& all = tree.depths[depth];
        const gim_cluster* const first = clusters.data() + all.first_cluster;
        indices.resize(3 * size_t{all.triangle_count});
        gim_read_cluster_triangles(first, all.cluster_count, vertices.data(), triangles.data(), indices.data());
        gim_cache_statistics cache;
        const gim_status counted = gim_count_cache_misses(indices.data(), all.triangle_count, open.vertex_count,
                                                          kCacheSize, work.data(), &cache);
        if (counted != GIM_OK) return counted;
        figures->push_back({depth, all.cluster_count, all.triangle_count, all.vertex_count, double{cache.acmr},
                            culled_share(first, all.cluster_count, all.triangle_count), double{all.error}});
    }
    return GIM_OK;
}

nlohmann::ordered_json to_json(const std::vector<ClusterFigures>& figures) {
    nlohmann::ordered_json depths = nlohmann::ordered_json::array();
    for (const ClusterFigures& f : figures) {
        depths.push_back({{"depth", f.depth},
                          {"clusters", f.clusters},
                          {"triangles", f.triangles},
                          {"vertices", f.vertices},
                          {"acmr", f.acmr},
                          {"culled", f.culled},
                          {"error", f.error}});
    }
    return depths;
}

void print_clusters(uint32_t image, const std::vector<ClusterFigures>& figures) {
    std::printf("image %u, clusters of 8 x 8 cells of level 0\n", image);
    std::printf("  depth   clusters  triangles  vertices in one  ACMR, 16 cached  culled from a side        error\n");
    for (const ClusterFigures& f : figures) {
        std::printf("  %5u  %9u  %9u  %15.1f  %15.3f  %16.1f %%  %11.4g\n", f.depth, f.clusters, f.triangles,
                    static_cast<double>(f.vertices) / f.clusters, f.acmr, 100 * f.culled, f.error);
    }
}

}  // namespace gim

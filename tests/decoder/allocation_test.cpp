// The decoder never asks for memory. A program of its own, because it counts every malloc of the process.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "gim/clusters.h"
#include "gim/decoder.h"
#include "tests/decoder/vectors.h"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
#define GIM_COUNTS_MALLOC 1
#else
#define GIM_COUNTS_MALLOC 0
#endif

#if GIM_COUNTS_MALLOC
static std::atomic<uint64_t> allocations{0};
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier, readability-identifier-naming): the C library's own names
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
// NOLINTEND(bugprone-reserved-identifier, readability-identifier-naming)
void* malloc(size_t size) {
    ++allocations;
    return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
    ++allocations;
    return __libc_calloc(count, size);
}
void* realloc(void* memory, size_t size) {
    ++allocations;
    return __libc_realloc(memory, size);
}
}
#endif

namespace gim {
namespace {

TEST(Allocation, NoCallOfTheDecoderAllocates) {
#if GIM_COUNTS_MALLOC
    for (const char* name :
         {"sphere-33-lossy", "torus-17-lossless", "two-images-lossless", "text-zstd", "planes-sphere-17",
          "charts-pillow-lossy", "charts-unequal-lossless", "tiles-cube-lossy", "tiles-genus-2-sharp-lossy"}) {
        const auto bytes = test::read_bytes(std::string(GIM_SOURCE_DIR) + "/spec/vectors/valid/" + name + ".gim");
        ASSERT_FALSE(bytes.empty());
        gim_info info;
        gim_level_info level;
        ASSERT_EQ(gim_read_info(bytes.data(), bytes.size(), nullptr, &info), GIM_OK);
        ASSERT_EQ(gim_read_level_info(&info, bytes.data(), bytes.size(), 0, 0, &level), GIM_OK);
        const size_t samples = size_t{level.width} * level.height;
        const bool has_ring = info.layout == GIM_LAYOUT_GIM;
        std::vector<float> x(samples * 3), n(samples * 3), uv(samples * 2);
        std::vector<uint32_t> t(level.triangle_count * 3), ring(4 * level.side);
        Scratch scratch(level.scratch_size + gim_text_scratch_size());
        std::string text(100000, '\0');
        const size_t room = scratch.size();
        const uint64_t before = allocations;

        // Shows that counting works.
        std::free(std::malloc(1));
        const uint64_t counted = allocations - before;

        gim_chunk chunk;
        uint64_t text_size = 0;
        uint32_t paths = 0;
        const void* b = bytes.data();
        const size_t size = bytes.size();
        int failures = 0;
        failures += gim_read_info(b, size, nullptr, &info) != GIM_OK;
        failures += gim_read_level_info(&info, b, size, 0, 0, &level) != GIM_OK;
        failures += gim_read_chunk(&info, b, size, 0, &chunk) != GIM_OK;
        failures += gim_read_seams(&info, b, size, 0, 0, has_ring ? ring.data() : nullptr, &paths) != GIM_OK;
        failures += gim_decode_positions(&info, b, size, 0, 0, x.data(), scratch.data(), room) != GIM_OK;
        failures += gim_decode_mesh(&info, b, size, 0, 0, x.data(), n.data(), uv.data(), t.data(), scratch.data(),
                                    room) != GIM_OK;
        failures += gim_decode_grid(&info, b, size, 0, 0, x.data(), n.data(), uv.data(), t.data(), scratch.data(),
                                    room) != GIM_OK;
        failures += gim_read_text(&info, b, size, text.data(), text.size(), &text_size, scratch.data(), room) != GIM_OK;
        gim_plane_info plane;
        if (gim_read_plane_info(&info, b, size, 0, GIM_PLANE_COLORS, 0, &plane) == GIM_OK)
            failures +=
                gim_decode_plane(&info, b, size, 0, GIM_PLANE_COLORS, 0, x.data(), scratch.data(), room) != GIM_OK;
        const uint64_t after = allocations;
        EXPECT_GE(counted, 1u);
        EXPECT_EQ(after - before, counted);
        EXPECT_EQ(failures, 0);
    }
#else
    GTEST_SKIP() << "malloc cannot be counted in this build";
#endif
}

TEST(Allocation, NeitherRefinementNorClustersAllocate) {
#if GIM_COUNTS_MALLOC
    for (const char* name : {"tiles-two-components-lossy", "torus-33-lossy"}) {
        const auto bytes = test::read_bytes(std::string(GIM_SOURCE_DIR) + "/spec/vectors/valid/" + name + ".gim");
        const void* b = bytes.data();
        const size_t size = bytes.size();
        gim_info info;
        gim_level_info level;
        gim_domain_info shape;
        ASSERT_EQ(gim_read_info(b, size, nullptr, &info), GIM_OK);
        ASSERT_EQ(gim_read_level_info(&info, b, size, 0, 0, &level), GIM_OK);
        ASSERT_EQ(gim_read_domain_info(&info, b, size, 0, 0, &shape), GIM_OK);
        std::vector<float> x(3 * size_t{level.vertex_count});
        const auto most = static_cast<uint32_t>(shape.most_triangles);
        // Sizes for clusters are known when the domain is open; this is more than they take.
        Scratch memory(shape.domain_size), scratch(std::max(level.scratch_size, shape.scratch_size) + (1 << 20)),
            mesh_memory(1 << 20);
        std::vector<gim_cluster> clusters(most);
        std::vector<uint32_t> vertices(6 * size_t{most}), work(level.vertex_count);
        std::vector<uint8_t> triangles(6 * size_t{most});
        ASSERT_EQ(
            gim_decode_mesh(&info, b, size, 0, 0, x.data(), nullptr, nullptr, nullptr, scratch.data(), scratch.size()),
            GIM_OK);
        const uint64_t before = allocations;
        int failures = 0;
        const gim_domain* domain = nullptr;
        failures += gim_open_domain(&info, b, size, 0, 0, x.data(), memory.data(), memory.size(), scratch.data(),
                                    scratch.size(), &domain) != GIM_OK;
        gim_refined* mesh = nullptr;
        failures += gim_begin_refined(domain, most, mesh_memory.data(), mesh_memory.size(), &mesh) != GIM_OK;
        gim_rule rule{};
        rule.object_error = 1e-3f;
        failures += gim_refine(mesh, &rule, 0, nullptr) != GIM_OK;
        gim_cluster_tree tree;
        failures += gim_decode_clusters(domain, 8, clusters.data(), vertices.data(), triangles.data(), scratch.data(),
                                        scratch.size(), &tree) != GIM_OK;
        gim_cache_statistics cache;
        uint32_t count = 0;
        const uint32_t* refined = gim_refined_triangles(mesh, &count);
        failures += gim_count_cache_misses(refined, count, level.vertex_count, 16, work.data(), &cache) != GIM_OK;
        EXPECT_EQ(allocations, before);
        EXPECT_EQ(failures, 0);
        gim_cluster_sizes sizes;
        ASSERT_EQ(gim_read_cluster_sizes(domain, 8, &sizes), GIM_OK);
        EXPECT_LE(sizes.cluster_count, clusters.size());
        EXPECT_LE(sizes.vertex_count, vertices.size());
        EXPECT_LE(3 * size_t{sizes.triangle_count}, triangles.size());
    }
#else
    GTEST_SKIP() << "malloc cannot be counted in this build";
#endif
}

}  // namespace
}  // namespace gim

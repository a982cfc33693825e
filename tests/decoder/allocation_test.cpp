// The decoder never asks for memory. A program of its own, because it counts every malloc of the process.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

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

}  // namespace
}  // namespace gim

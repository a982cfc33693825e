// libFuzzer target: any bytes through every call of gim/decoder.h. Nothing may crash, hang, or read what is not there; what a
// successful decode returns must be finite, and its indices in range.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "gim/decoder.h"

namespace {

void require(bool holds) {
    if (!holds) std::abort();
}

void decode_level(const gim_info& info, const uint8_t* bytes, size_t size, uint32_t image, uint32_t level) {
    gim_level_info shape;
    if (gim_read_level_info(&info, bytes, size, image, level, &shape) != GIM_OK) return;
    std::vector<float> positions(size_t{shape.vertex_count} * 3), normals(positions.size());
    std::vector<float> texcoords(size_t{shape.vertex_count} * 2);
    std::vector<uint32_t> triangles(size_t{shape.triangle_count} * 3);
    std::vector<std::max_align_t> scratch(shape.scratch_size / sizeof(std::max_align_t) + 1);
    const gim_status status = gim_decode_mesh(&info, bytes, size, image, level, positions.data(), normals.data(),
                                              texcoords.data(), triangles.data(), scratch.data(), shape.scratch_size);
    if (status != GIM_OK) return;
    require(shape.prefix_size <= size);
    for (const uint32_t v : triangles) require(v < shape.vertex_count);
    for (const float t : texcoords) require(t >= 0 && t <= 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
    const gim_limits limits{uint64_t{1} << 18, 16, 513};
    gim_info info;
    if (gim_read_info(bytes, size, &limits, &info) != GIM_OK) return 0;
    gim_chunk chunk;
    for (uint32_t i = 0; gim_read_chunk(&info, bytes, size, i, &chunk) == GIM_OK; ++i) require(i < info.chunk_count);
    for (uint32_t image = 0; image < info.image_count; ++image) {
        for (uint32_t level = 0; level <= info.level_count; ++level) decode_level(info, bytes, size, image, level);
    }
    return 0;
}

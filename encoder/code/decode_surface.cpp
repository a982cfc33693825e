#include "encoder/code/decode_surface.h"

#include <algorithm>
#include <string>
#include <vector>

#include "encoder/base/result.h"
#include "gim/decoder.h"

namespace gim {

namespace {

Error decoding_error(gim_status status) {
    return {Stage::kCode, std::string("own output: ") + gim_status_text(status)};
}

gim_status append_image(std::span<const uint8_t> bytes, const gim_info& info, uint32_t image, uint32_t level,
                        Mesh& mesh) {
    gim_level_info size;
    gim_status status = gim_read_level_info(&info, bytes.data(), bytes.size(), image, 0, &size);
    if (status != GIM_OK) return status;
    level = std::min(level, size.coarsest_level);
    status = gim_read_level_info(&info, bytes.data(), bytes.size(), image, level, &size);
    if (status != GIM_OK) return status;
    std::vector<float> positions(size_t{size.vertex_count} * 3);
    std::vector<uint32_t> triangles(size_t{size.triangle_count} * 3);
    std::vector<uint8_t> scratch(size.scratch_size);
    status = gim_decode_mesh(&info, bytes.data(), bytes.size(), image, level, positions.data(), nullptr, nullptr,
                             triangles.data(), scratch.data(), scratch.size());
    if (status != GIM_OK) return status;
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (size_t v = 0; v < positions.size(); v += 3)
        mesh.positions.emplace_back(positions[v], positions[v + 1], positions[v + 2]);
    for (size_t t = 0; t < triangles.size(); t += 3) {
        mesh.triangles.push_back({first + triangles[t], first + triangles[t + 1], first + triangles[t + 2]});
    }
    return GIM_OK;
}

}  // namespace

Result<gim_info> read_own_info(std::span<const uint8_t> bytes) {
    const gim_limits no_limits{UINT64_MAX, UINT32_MAX, UINT32_MAX};
    gim_info info;
    const gim_status status = gim_read_info(bytes.data(), bytes.size(), &no_limits, &info);
    if (status != GIM_OK) return decoding_error(status);
    return info;
}

Result<Mesh> decode_surface(std::span<const uint8_t> bytes, uint32_t level) {
    GIM_TRY(info, read_own_info(bytes));
    Mesh mesh;
    for (uint32_t image = 0; image < info.image_count; ++image) {
        const gim_status status = append_image(bytes, info, image, level, mesh);
        if (status != GIM_OK) return decoding_error(status);
    }
    return mesh;
}

Result<Comparison> compare_file(std::span<const uint8_t> bytes, const ReferenceSurface& reference,
                                const CompareOptions& options) {
    GIM_TRY(decoded, decode_surface(bytes, 0));
    return reference.compare(decoded, options);
}

Result<uint32_t> coarsest_level(std::span<const uint8_t> bytes) {
    GIM_TRY(info, read_own_info(bytes));
    uint32_t coarsest = info.level_count - 1;
    for (uint32_t image = 0; image < info.image_count; ++image) {
        gim_level_info size;
        const gim_status status = gim_read_level_info(&info, bytes.data(), bytes.size(), image, 0, &size);
        if (status != GIM_OK) return decoding_error(status);
        coarsest = std::min(coarsest, size.coarsest_level);
    }
    return coarsest;
}

}  // namespace gim

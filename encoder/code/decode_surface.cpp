#include "encoder/code/decode_surface.h"

#include <algorithm>
#include <string>
#include <vector>

namespace gim {

namespace {

gim_status append_image(Decoder& decoder, uint32_t image, uint32_t level, Mesh& mesh) {
    DecoderLevel size;
    gim_status status = decoder.read_level(image, 0, &size);
    if (status != GIM_OK) return status;
    const uint32_t wanted = std::min(level, size.coarsest_level);
    if (wanted > 0) status = decoder.read_level(image, wanted, &size);
    if (status != GIM_OK) return status;
    std::vector<float> positions(size_t{size.vertex_count} * 3);
    std::vector<uint32_t> triangles(size_t{size.triangle_count} * 3);
    status = decoder.mesh(size, {positions, {}, {}, triangles});
    if (status != GIM_OK) return status;
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    append_positions(decoder.info(), positions, mesh);
    for (size_t t = 0; t < triangles.size(); t += 3) {
        mesh.triangles.push_back({first + triangles[t], first + triangles[t + 1], first + triangles[t + 2]});
    }
    return GIM_OK;
}

}  // namespace

void append_positions(const gim_info& info, std::span<const float> positions, Mesh& mesh) {
    const Vec3 origin = info.is_relative ? Vec3(info.origin[0], info.origin[1], info.origin[2]) : Vec3(0, 0, 0);
    for (size_t v = 0; v < positions.size(); v += 3)
        mesh.positions.push_back(origin + Vec3(positions[v], positions[v + 1], positions[v + 2]));
}

Error decoding_error(Stage stage, gim_status status) {
    return {stage, std::string("own output: ") + gim_status_text(status)};
}

gim_status open_own_file(std::span<const uint8_t> bytes, Decoder* decoder) {
    const gim_limits no_limits{UINT64_MAX, UINT32_MAX, UINT32_MAX};
    return decoder->open(bytes, &no_limits);
}

Result<gim_info> read_own_info(std::span<const uint8_t> bytes) {
    Decoder decoder;
    const gim_status status = open_own_file(bytes, &decoder);
    if (status != GIM_OK) return decoding_error(Stage::kCode, status);
    return decoder.info();
}

Result<Mesh> decode_surface(std::span<const uint8_t> bytes, uint32_t level) {
    Decoder decoder;
    Mesh mesh;
    gim_status status = open_own_file(bytes, &decoder);
    for (uint32_t image = 0; status == GIM_OK && image < decoder.info().image_count; ++image)
        status = append_image(decoder, image, level, mesh);
    if (status != GIM_OK) return decoding_error(Stage::kCode, status);
    return mesh;
}

Result<Comparison> compare_file(std::span<const uint8_t> bytes, const ReferenceSurface& reference,
                                const CompareOptions& options) {
    GIM_TRY(decoded, decode_surface(bytes, 0));
    return reference.compare(decoded, options);
}

Result<uint32_t> coarsest_level(std::span<const uint8_t> bytes) {
    Decoder decoder;
    gim_status status = open_own_file(bytes, &decoder);
    uint32_t coarsest = decoder.info().level_count - 1;
    for (uint32_t image = 0; status == GIM_OK && image < decoder.info().image_count; ++image) {
        DecoderLevel size;
        status = decoder.read_level(image, 0, &size);
        coarsest = std::min(coarsest, size.coarsest_level);
    }
    if (status != GIM_OK) return decoding_error(Stage::kCode, status);
    return coarsest;
}

}  // namespace gim

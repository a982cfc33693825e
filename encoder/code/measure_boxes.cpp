#include "encoder/code/measure_boxes.h"

#include <algorithm>
#include <limits>

#include "encoder/code/decode_surface.h"

namespace gim {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr Box kEmpty = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

void include(std::span<const float> triples, Box* box) {
    for (size_t i = 0; i < triples.size(); ++i) {
        box->low[i % 3] = std::min(box->low[i % 3], triples[i]);
        box->high[i % 3] = std::max(box->high[i % 3], triples[i]);
    }
}

gim_status include_levels(Decoder& decoder, uint32_t image, Box* box) {
    DecoderLevel level;
    gim_status status = decoder.read_level(image, 0, &level);
    const uint32_t coarsest = level.coarsest_level;
    for (uint32_t k = 0; status == GIM_OK && k <= coarsest; ++k) {
        status = decoder.read_level(image, k, &level);
        if (status != GIM_OK) break;
        std::vector<float> positions(size_t{level.vertex_count} * 3);
        status = decoder.mesh(level, {positions, {}, {}, {}});
        include(positions, box);
    }
    return status;
}

// Moves the faces of the box as far as displacements may move points.
gim_status include_displacements(Decoder& decoder, uint32_t image, Box* box) {
    Box moves;  // 0 0 0 is one of them
    DecoderPlane plane;
    gim_status status = decoder.read_plane(image, GIM_PLANE_DISPLACEMENTS, 0, &plane);
    if (status == GIM_NO_SUCH_PLANE) return GIM_OK;
    const uint32_t coarsest = plane.coarsest_level;
    for (uint32_t k = 0; status == GIM_OK && k <= coarsest; ++k) {
        status = decoder.read_plane(image, GIM_PLANE_DISPLACEMENTS, k, &plane);
        if (status != GIM_OK) break;
        std::vector<float> values(size_t{plane.width} * plane.height * 3);
        status = decoder.plane(plane, values);
        include(values, &moves);
    }
    for (size_t k = 0; k < 3; ++k) {
        box->low[k] += moves.low[k];
        box->high[k] += moves.high[k];
    }
    return status;
}

}  // namespace

Result<std::vector<Box>> measure_boxes(std::span<const uint8_t> bytes) {
    Decoder decoder;
    gim_status status = open_own_file(bytes, &decoder);
    std::vector<Box> boxes;
    for (uint32_t image = 0; status == GIM_OK && image < decoder.info().image_count; ++image) {
        Box& box = boxes.emplace_back(kEmpty);
        status = include_levels(decoder, image, &box);
        if (status == GIM_OK) status = include_displacements(decoder, image, &box);
    }
    if (status != GIM_OK) return decoding_error(Stage::kCode, status);
    return boxes;
}

}  // namespace gim

#include "format/plane_code.h"

#include <algorithm>

#include "format/bytes.h"
#include "format/seam.h"
#include "format/stream_table.h"
#include "format/tile_atlas.h"

namespace gim {
namespace {

constexpr uint8_t kLossyWavelet = 0;  // other codings are for later versions

struct Size {
    uint64_t width = 0, height = 0;
};

bool is_exponent(const Header& header, uint32_t j) {
    if (header.layout == FileLayout::kSquares) return j >= 1 && j <= kMaxSideExponent;
    if (j > kMaxTexelExponent) return false;
    return header.layout == FileLayout::kCharts || header.tiles.exponent + j <= kMaxSideExponent;
}

Size size_of(const Header& header, uint32_t j) {
    if (header.layout == FileLayout::kSquares) return {(uint64_t{1} << j) + 1, (uint64_t{1} << j) + 1};
    if (header.layout == FileLayout::kCharts) return {texels_along(header.width, j), texels_along(header.height, j)};
    const TileAtlas atlas(header.tiles.tiles, header.tiles.intervals(0));
    return {texels_along(atlas.width(), j), texels_along(atlas.height(), j)};
}

}  // namespace

Status parse_plane(std::span<const uint8_t> payload, const Header& header, uint32_t image,
                   const ContainerLimits& limits, PlaneChunk* plane) {
    const uint32_t image_count = header.image_count();
    ByteReader reader(payload);
    uint8_t coding = 0;
    if (!reader.read_u8(&coding)) return Status::kMalformed;
    if (coding != kLossyWavelet) return Status::kUnsupportedVersion;
    if (!reader.read_f32(&plane->quantizer) ||
        !(plane->quantizer >= kMinQuantizer && plane->quantizer <= kMaxQuantizer))
        return Status::kMalformed;

    const size_t sides_at = reader.position();
    if (!reader.skip(image_count)) return Status::kMalformed;
    plane->side_exponents = payload.subspan(sides_at, image_count);
    uint64_t samples = 0, largest = 0;
    for (const uint8_t j : plane->side_exponents) {
        if (!is_exponent(header, j)) return Status::kMalformed;
        const auto [width, height] = size_of(header, j);
        samples += width * height;  // at most 2^16 * 2^29
        largest = std::max({largest, width, height});
    }
    if (largest > limits.max_side || samples > limits.max_samples) return Status::kLimitExceeded;

    return find_stream(payload.subspan(reader.position()), image_count, image, &plane->stream);
}

std::vector<uint8_t> serialize_plane(float quantizer, std::span<const uint8_t> side_exponents,
                                     std::span<const std::vector<uint8_t>> streams) {
    std::vector<uint8_t> payload = {kLossyWavelet};
    append_f32(quantizer, &payload);
    payload.insert(payload.end(), side_exponents.begin(), side_exponents.end());
    append_streams(streams, &payload);
    return payload;
}

}  // namespace gim

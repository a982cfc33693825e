#include "format/plane_code.h"

#include <algorithm>

#include "format/bytes.h"
#include "format/seam.h"

namespace gim {
namespace {

constexpr uint8_t kLossyWavelet = 0;  // other codings are for later versions

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
    const bool charts = header.layout == FileLayout::kCharts;
    uint64_t samples = 0, largest = 0;
    for (const uint8_t j : plane->side_exponents) {
        if (charts ? j > kMaxTexelExponent : j < 1 || j > kMaxSideExponent) return Status::kMalformed;
        const uint64_t width = charts ? chart_plane_side(header.width, j) : (uint64_t{1} << j) + 1,
                       height = charts ? chart_plane_side(header.height, j) : width;
        samples += width * height;  // at most 2^16 * 2^29
        largest = std::max({largest, width, height});
    }
    if (largest > limits.max_side || samples > limits.max_samples) return Status::kLimitExceeded;

    // Sizes of the streams. A single image has the rest of the payload.
    uint64_t offset = 0, size = reader.left(), total = size;
    if (image_count > 1) {
        total = 0;
        for (uint32_t i = 0; i < image_count; ++i) {
            uint64_t one = 0;
            if (!reader.read_leb128(&one)) return Status::kMalformed;
            if (i == image) {
                offset = total;
                size = one;
            }
            total += one;  // at most 2^16 * 2^42
        }
    }
    if (total != reader.left()) return Status::kMalformed;
    plane->stream = payload.subspan(reader.position() + static_cast<size_t>(offset), static_cast<size_t>(size));
    return Status::kOk;
}

std::vector<uint8_t> serialize_plane(float quantizer, std::span<const uint8_t> side_exponents,
                                     std::span<const std::vector<uint8_t>> streams) {
    std::vector<uint8_t> payload = {kLossyWavelet};
    append_f32(quantizer, &payload);
    payload.insert(payload.end(), side_exponents.begin(), side_exponents.end());
    if (streams.size() > 1) {
        for (const auto& stream : streams) append_leb128(stream.size(), &payload);
    }
    for (const auto& stream : streams) payload.insert(payload.end(), stream.begin(), stream.end());
    return payload;
}

}  // namespace gim

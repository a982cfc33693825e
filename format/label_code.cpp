#include "format/label_code.h"

#include "format/bytes.h"

namespace gim {

Status find_label_stream(std::span<const uint8_t> payload, uint32_t image_count, uint32_t image,
                         std::span<const uint8_t>* stream) {
    *stream = payload;
    if (image_count == 1) return Status::kOk;
    ByteReader reader(payload);
    uint64_t offset = 0, size = 0, total = 0;
    for (uint32_t i = 0; i < image_count; ++i) {
        uint64_t one = 0;
        if (!reader.read_leb128(&one)) return Status::kMalformed;
        if (i == image) {
            offset = total;
            size = one;
        }
        total += one;  // at most 2^16 * 2^42
    }
    if (total != reader.left()) return Status::kMalformed;
    *stream = payload.subspan(reader.position() + static_cast<size_t>(offset), static_cast<size_t>(size));
    return Status::kOk;
}

std::vector<uint8_t> serialize_labels(std::span<const std::vector<uint8_t>> streams) {
    std::vector<uint8_t> payload;
    if (streams.size() > 1) {
        for (const auto& stream : streams) append_leb128(stream.size(), &payload);
    }
    for (const auto& stream : streams) payload.insert(payload.end(), stream.begin(), stream.end());
    return payload;
}

}  // namespace gim

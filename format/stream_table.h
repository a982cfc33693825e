// Payloads with one stream for each image: the sizes of all streams, then the streams. A single image has no size.
// spec/gim-format.md, "Levels", "Planes", "Labels".
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "format/bytes.h"
#include "format/status.h"

namespace gim {

// Finds the stream of an image in `bytes`, which hold nothing else. has_stream(i): whether image i has one; `image` does.
template <class HasStream>
Status find_stream(std::span<const uint8_t> bytes, uint32_t image_count, uint32_t image, const HasStream& has_stream,
                   std::span<const uint8_t>* stream) {
    *stream = bytes;
    if (image_count == 1) return Status::kOk;
    ByteReader reader(bytes);
    uint64_t offset = 0, size = 0, total = 0;
    for (uint32_t i = 0; i < image_count; ++i) {
        if (!has_stream(i)) continue;
        uint64_t one = 0;
        if (!reader.read_leb128(&one)) return Status::kMalformed;
        if (i == image) {
            offset = total;
            size = one;
        }
        total += one;  // at most 2^16 * 2^42
    }
    if (total != reader.left()) return Status::kMalformed;
    *stream = bytes.subspan(reader.position() + static_cast<size_t>(offset), static_cast<size_t>(size));
    return Status::kOk;
}

// The same where every image has a stream.
inline Status find_stream(std::span<const uint8_t> bytes, uint32_t image_count, uint32_t image,
                          std::span<const uint8_t>* stream) {
    return find_stream(
        bytes, image_count, image, [](uint32_t) { return true; }, stream);
}

// Appends table and streams, one stream for each image.
inline void append_streams(std::span<const std::vector<uint8_t>> streams, std::vector<uint8_t>* bytes) {
    if (streams.size() > 1) {
        for (const auto& stream : streams) append_leb128(stream.size(), bytes);
    }
    for (const auto& stream : streams) bytes->insert(bytes->end(), stream.begin(), stream.end());
}

}  // namespace gim

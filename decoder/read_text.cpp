// Reads the META chunk into the caller's memory.
#include <algorithm>
#include <cstdint>

#include "decoder/reopen.h"
#include "decoder/unpack_text.h"
#include "gim/decoder.h"

using namespace gim;

namespace {

Status read_text(const gim_info* info, const void* bytes, size_t size, char* text, size_t capacity, uint64_t* text_size,
                 void* scratch, size_t scratch_size) {
    Header header;
    Chunk chunk;
    uint64_t offset = 0;
    if (Status s = reopen(info, bytes, size, &header); s != Status::kOk) return s;
    *text_size = 0;
    if (!find_chunk(header, ChunkType::kText, &chunk, &offset)) return Status::kOk;
    *text_size = chunk.raw_size;
    if (!text) return Status::kOk;
    if (capacity < chunk.raw_size) return Status::kScratchTooSmall;
    std::span<const uint8_t> payload;
    if (Status s = read_payload({static_cast<const uint8_t*>(bytes), size}, chunk, offset, &payload); s != Status::kOk)
        return s;
    if (chunk.zstd) return unpack_text(payload, text, static_cast<size_t>(chunk.raw_size), scratch, scratch_size);
    std::copy(payload.begin(), payload.end(), text);
    return Status::kOk;
}

}  // namespace

size_t gim_text_scratch_size(void) { return unpack_scratch_size(); }

gim_status gim_read_text(const gim_info* info, const void* bytes, size_t size, char* text, size_t capacity,
                         uint64_t* text_size, void* scratch, size_t scratch_size) {
    if (!text_size) return GIM_BAD_ARGUMENT;
    return static_cast<gim_status>(read_text(info, bytes, size, text, capacity, text_size, scratch, scratch_size));
}

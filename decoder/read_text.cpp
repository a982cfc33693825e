// Unpacks the META chunk into the caller's memory. The zstd context is in the caller's scratch: nothing is allocated.
#define ZSTD_STATIC_LINKING_ONLY  // for contexts in our own memory
#include <zstd.h>

#include <algorithm>
#include <cstdint>

#include "decoder/reopen.h"
#include "gim/decoder.h"

using namespace gim;

namespace {

Status unpack(std::span<const uint8_t> payload, char* text, size_t size, void* scratch, size_t scratch_size) {
    if (!scratch || reinterpret_cast<uintptr_t>(scratch) % 16 != 0) return Status::kBadArgument;
    ZSTD_DCtx* context = ZSTD_initStaticDCtx(scratch, scratch_size);
    if (!context) return Status::kScratchTooSmall;
    const size_t unpacked = ZSTD_decompressDCtx(context, text, size, payload.data(), payload.size());
    return !ZSTD_isError(unpacked) && unpacked == size ? Status::kOk : Status::kMalformed;
}

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
    if (chunk.zstd) return unpack(payload, text, static_cast<size_t>(chunk.raw_size), scratch, scratch_size);
    std::copy(payload.begin(), payload.end(), text);
    return Status::kOk;
}

}  // namespace

size_t gim_text_scratch_size(void) { return ZSTD_estimateDCtxSize(); }

gim_status gim_read_text(const gim_info* info, const void* bytes, size_t size, char* text, size_t capacity,
                         uint64_t* text_size, void* scratch, size_t scratch_size) {
    if (!text_size) return GIM_BAD_ARGUMENT;
    return static_cast<gim_status>(read_text(info, bytes, size, text, capacity, text_size, scratch, scratch_size));
}

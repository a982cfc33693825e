// With zstd. Its context is in the caller's scratch: nothing is allocated.
#define ZSTD_STATIC_LINKING_ONLY  // for contexts in our own memory
#include "decoder/unpack_text.h"

#include <zstd.h>

namespace gim {

size_t unpack_scratch_size() { return ZSTD_estimateDCtxSize(); }

Status unpack_text(std::span<const uint8_t> payload, char* text, size_t size, void* scratch, size_t scratch_size) {
    if (!scratch || reinterpret_cast<uintptr_t>(scratch) % 16 != 0) return Status::kBadArgument;
    ZSTD_DCtx* context = ZSTD_initStaticDCtx(scratch, scratch_size);
    if (!context) return Status::kScratchTooSmall;
    const size_t unpacked = ZSTD_decompressDCtx(context, text, size, payload.data(), payload.size());
    return !ZSTD_isError(unpacked) && unpacked == size ? Status::kOk : Status::kMalformed;
}

}  // namespace gim

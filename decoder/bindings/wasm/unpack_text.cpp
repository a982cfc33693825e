// Without zstd: compressed text is refused.
#include "decoder/unpack_text.h"

namespace gim {

size_t unpack_scratch_size() { return 0; }

Status unpack_text(std::span<const uint8_t>, char*, size_t, void*, size_t) { return Status::kUnsupportedVersion; }

}  // namespace gim

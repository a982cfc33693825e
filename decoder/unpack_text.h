// Unpacks a compressed META chunk. A build without zstd links another source with the same functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "format/status.h"

namespace gim {

// Bytes of scratch that unpack_text needs.
size_t unpack_scratch_size();

// text: room for `size` bytes; the payload must unpack to exactly as many. scratch: aligned to 16 bytes.
Status unpack_text(std::span<const uint8_t> payload, char* text, size_t size, void* scratch, size_t scratch_size);

}  // namespace gim

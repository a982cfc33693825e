// Checksums of the container.  spec/gim-format.md, "Checksums".
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace gim {

// CRC-32 of zlib and PNG: polynomial 0x04C11DB7 reflected, initial and final value all ones.
uint32_t crc32(std::span<const uint8_t> bytes);

// CRC-16/CCITT-FALSE: polynomial 0x1021, not reflected, initial value 0xFFFF, no final inversion.
// Unlike half of a CRC-32 it finds every burst of up to 16 bits.
uint16_t crc16(std::span<const uint8_t> bytes);

}  // namespace gim

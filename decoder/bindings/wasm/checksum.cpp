// The checksums of format/checksum.h with small tables: four bits at a time.
#include "format/checksum.h"

#include <array>

namespace gim {
namespace {

constexpr auto kCrc32 = [] {
    std::array<uint32_t, 16> table{};
    for (uint32_t b = 0; b < 16; ++b) {
        uint32_t c = b;
        for (int i = 0; i < 4; ++i) c = c & 1 ? c >> 1 ^ 0xEDB88320u : c >> 1;
        table[b] = c;
    }
    return table;
}();

}  // namespace

uint32_t crc32(std::span<const uint8_t> bytes) {
    uint32_t c = 0xFFFFFFFFu;
    for (const uint8_t byte : bytes) {
        c ^= byte;
        c = c >> 4 ^ kCrc32[c & 15];
        c = c >> 4 ^ kCrc32[c & 15];
    }
    return ~c;
}

// The polynomial is x^16 + x^12 + x^5 + 1, so that a few shifts do for a table.
uint16_t crc16(std::span<const uint8_t> bytes) {
    uint32_t c = 0xFFFFu;
    for (const uint8_t byte : bytes) {
        uint32_t x = c >> 8 ^ byte;
        x ^= x >> 4;
        c = (c << 8 ^ x << 12 ^ x << 5 ^ x) & 0xFFFF;
    }
    return static_cast<uint16_t>(c);
}

}  // namespace gim

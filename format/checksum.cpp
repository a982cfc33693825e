#include "format/checksum.h"

#include <array>

namespace gim {
namespace {

// table[k][b]: the effect of byte b followed by k zero bytes. With it one step takes eight bytes.
constexpr auto kCrc32 = [] {
    std::array<std::array<uint32_t, 256>, 8> table{};
    for (uint32_t b = 0; b < 256; ++b) {
        uint32_t c = b;
        for (int i = 0; i < 8; ++i) c = c & 1 ? c >> 1 ^ 0xEDB88320u : c >> 1;
        table[0][b] = c;
    }
    for (size_t k = 1; k < 8; ++k)
        for (uint32_t b = 0; b < 256; ++b) table[k][b] = table[k - 1][b] >> 8 ^ table[0][table[k - 1][b] & 0xFF];
    return table;
}();

constexpr auto kCrc16 = [] {
    std::array<std::array<uint16_t, 256>, 8> table{};
    for (uint32_t b = 0; b < 256; ++b) {
        uint32_t c = b << 8;
        for (int i = 0; i < 8; ++i) c = (c & 0x8000 ? c << 1 ^ 0x1021u : c << 1) & 0xFFFF;
        table[0][b] = static_cast<uint16_t>(c);
    }
    for (size_t k = 1; k < 8; ++k)
        for (uint32_t b = 0; b < 256; ++b)
            table[k][b] = static_cast<uint16_t>(table[k - 1][b] << 8 ^ table[0][table[k - 1][b] >> 8]);
    return table;
}();

}  // namespace

uint32_t crc32(std::span<const uint8_t> bytes) {
    uint32_t c = 0xFFFFFFFFu;
    size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) {
        const uint8_t* p = bytes.data() + i;
        c = kCrc32[7][p[0] ^ (c & 0xFF)] ^ kCrc32[6][p[1] ^ (c >> 8 & 0xFF)] ^ kCrc32[5][p[2] ^ (c >> 16 & 0xFF)] ^
            kCrc32[4][p[3] ^ c >> 24] ^ kCrc32[3][p[4]] ^ kCrc32[2][p[5]] ^ kCrc32[1][p[6]] ^ kCrc32[0][p[7]];
    }
    for (; i < bytes.size(); ++i) c = c >> 8 ^ kCrc32[0][(c ^ bytes[i]) & 0xFF];
    return ~c;
}

uint16_t crc16(std::span<const uint8_t> bytes) {
    uint32_t c = 0xFFFFu;
    size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) {
        const uint8_t* p = bytes.data() + i;
        c = static_cast<uint32_t>(kCrc16[7][p[0] ^ c >> 8] ^ kCrc16[6][p[1] ^ (c & 0xFF)] ^ kCrc16[5][p[2]] ^
                                  kCrc16[4][p[3]] ^ kCrc16[3][p[4]] ^ kCrc16[2][p[5]] ^ kCrc16[1][p[6]] ^
                                  kCrc16[0][p[7]]);
    }
    for (; i < bytes.size(); ++i) c = (c << 8 & 0xFFFF) ^ kCrc16[0][c >> 8 ^ bytes[i]];
    return static_cast<uint16_t>(c);
}

}  // namespace gim

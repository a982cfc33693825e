#include "format/checksum.h"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

namespace gim {
namespace {

std::vector<uint8_t> bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

TEST(Checksum, CheckValuesOfTheCatalogue) {
    EXPECT_EQ(crc32(bytes_of("123456789")), 0xCBF43926u);
    EXPECT_EQ(crc16(bytes_of("123456789")), 0x29B1u);
    EXPECT_EQ(crc32({}), 0u);
    EXPECT_EQ(crc16({}), 0xFFFFu);
}

// The reference: one bit at a time.
TEST(Checksum, EightBytesAtATimeGiveTheSameAsOneBitAtATime) {
    std::vector<uint8_t> bytes;
    for (uint32_t n = 0; n < 70; ++n) {
        uint32_t c32 = 0xFFFFFFFFu, c16 = 0xFFFF;
        for (const uint8_t b : bytes) {
            c32 ^= b;
            for (int i = 0; i < 8; ++i) c32 = c32 & 1 ? c32 >> 1 ^ 0xEDB88320u : c32 >> 1;
            c16 ^= uint32_t{b} << 8;
            for (int i = 0; i < 8; ++i) c16 = (c16 & 0x8000 ? c16 << 1 ^ 0x1021 : c16 << 1) & 0xFFFF;
        }
        ASSERT_EQ(crc32(bytes), ~c32) << n;
        ASSERT_EQ(crc16(bytes), c16) << n;
        bytes.push_back(static_cast<uint8_t>(n * 37 + 11));
    }
}

TEST(Checksum, EveryBitCounts) {
    std::vector<uint8_t> bytes(300, 0xA5);
    const uint32_t c32 = crc32(bytes);
    const uint16_t c16 = crc16(bytes);
    for (size_t bit = 0; bit < bytes.size() * 8; ++bit) {
        bytes[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
        EXPECT_NE(crc32(bytes), c32);
        EXPECT_NE(crc16(bytes), c16);
        bytes[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
    }
}

}  // namespace
}  // namespace gim

#include "format/container.h"

#include <gtest/gtest.h>

#include <limits>

#include "format/checksum.h"

namespace gim {
namespace {

const std::vector<uint8_t> kOneSide = {5};

Header small_header() {
    Header h;
    h.bits = 12;
    h.level_count = 2;
    h.origin = {1, -2, 3};
    h.step = 0.5f;
    h.side_exponents = kOneSide;
    return h;
}

Chunk chunk(ChunkType type, uint64_t size, bool optional = false) {
    Chunk c;
    c.type = type;
    c.size = c.raw_size = size;
    c.optional = optional;
    c.crc = 0x1234;
    return c;
}

const std::vector<Chunk> kChunks = {chunk(ChunkType::kSeams, 9), chunk(ChunkType::kLevel, 200),
                                    chunk(ChunkType::kLevel, 3000)};

Status parse(const std::vector<uint8_t>& bytes, Header* h, const ContainerLimits& limits = {}) {
    return parse_header(bytes, limits, h);
}

// Index_Size is one byte in these files, so the body can be changed and signed again.
std::vector<uint8_t> signed_again(std::vector<uint8_t> bytes) {
    bytes.resize(bytes.size() - 4);
    append_u32(crc32(bytes), &bytes);
    return bytes;
}

TEST(Container, HandWrittenBytesParse) {
    std::vector<uint8_t> bytes = {0x89, 'G',  'I',  'M',  0x0D, 0x0A, 0x1A, 1, 46,   0x00, 12, 1, 1,
                                  2,    0,    0,    0x80, 0x3F, 0,    0,    0, 0xC0, 0,    0,  0, 0,  // origin 1, -2, 0
                                  0,    0,    0,    0x3F,                                             // step 0.5
                                  0x00, 1,    0xAA, 0xBB,                                             // SEAM
                                  0x04, 0x81, 0x01, 0xCC, 0xDD,                                       // LEVL, 129 bytes
                                  0x09, 7,    0xEE, 0xFF};                                            // META
    bytes[8] = static_cast<uint8_t>(bytes.size() + 4);
    append_u32(crc32(bytes), &bytes);
    Header h;
    ASSERT_EQ(parse(bytes, &h), Status::kOk);
    EXPECT_EQ(h.coding, Coding::kLossless);
    EXPECT_EQ(h.image_count(), 1u);
    EXPECT_EQ(h.side(0), 5u);
    EXPECT_EQ(h.origin[1], -2.0f);
    EXPECT_EQ(h.step, 0.5f);
    EXPECT_EQ(h.chunk_count, 3u);
    EXPECT_EQ(h.file_size, bytes.size() + 1 + 129 + 7);
    ChunkWalk walk(h);
    Chunk c;
    uint64_t offset = 0;
    ASSERT_TRUE(walk.next(&c, &offset));
    EXPECT_EQ(c.crc, 0xBBAA);
    ASSERT_TRUE(walk.next(&c, &offset));
    EXPECT_EQ(c.size, 129u);
    EXPECT_EQ(offset, bytes.size() + 1);
    ASSERT_TRUE(walk.next(&c, &offset));
    EXPECT_TRUE(c.optional);
    EXPECT_FALSE(walk.next(&c, &offset));
}

// A lossy file of one level with quantizer 1.5 and the next two bytes as given. Its index may be cut short.
std::vector<uint8_t> lossy_bytes(std::vector<uint8_t> tangential_and_area) {
    std::vector<uint8_t> bytes = {0x89, 'G', 'I', 'M',  0x0D, 0x0A, 0x1A, 1,   0, 0x04, 12, 1, 1,
                                  2,    0,   0,   0,    0,    0,    0,    0,   0, 0,    0,  0, 0,  // origin 0
                                  0,    0,   0,   0x3F, 0,    0,    0xC0, 0x3F};  // step 0.5, quantizer
    for (const uint8_t byte : tangential_and_area) bytes.push_back(byte);
    for (const int byte : {0x00, 1, 0xAA, 0xBB, 0x04, 2, 0xCC, 0xDD})
        bytes.push_back(static_cast<uint8_t>(byte));  // SEAM, LEVL
    bytes[8] = static_cast<uint8_t>(bytes.size() + 4);
    append_u32(crc32(bytes), &bytes);
    return bytes;
}

TEST(Container, LossyFilesSayHowDetailsAreQuantized) {
    Header h;
    ASSERT_EQ(parse(lossy_bytes({24, 75}), &h), Status::kOk);
    EXPECT_EQ(h.coding, Coding::kLossy);
    EXPECT_EQ(h.quantizer, 1.5f);
    EXPECT_EQ(h.tangential, 24);
    EXPECT_EQ(h.cell_area, 75);
    EXPECT_EQ(h.chunk_count, 2u);
    EXPECT_EQ(parse(lossy_bytes({255, 255}), &h), Status::kOk);
    EXPECT_EQ(parse(lossy_bytes({1, 0}), &h), Status::kOk);
    EXPECT_EQ(parse(lossy_bytes({0, 0}), &h), Status::kOk);
}

TEST(Container, AnAreaWithoutFramesIsMalformed) {
    Header h;
    EXPECT_EQ(parse(lossy_bytes({0, 1}), &h), Status::kMalformed);
    EXPECT_EQ(parse(lossy_bytes({0, 255}), &h), Status::kMalformed);
}

TEST(Container, LossyFilesWithoutTheTwoBytesAreMalformed) {
    Header h;
    EXPECT_EQ(parse(lossy_bytes({}), &h), Status::kMalformed);
    EXPECT_EQ(parse(lossy_bytes({24}), &h), Status::kMalformed);
}

TEST(Container, CellAreasAreFourToAnOctave) {
    EXPECT_EQ(cell_area_of(0), 0.0f);
    EXPECT_EQ(cell_area_of(1), 5 * 0x1p-20f);
    EXPECT_EQ(cell_area_of(4), 0x1p-17f);
    EXPECT_EQ(cell_area_of(80), 4.0f);
    EXPECT_EQ(cell_area_of(83), 7.0f);
    EXPECT_EQ(cell_area_of(255), 7 * 0x1p43f);
    for (int code = 1; code < 256; ++code)
        EXPECT_GT(cell_area_of(static_cast<uint8_t>(code)), cell_area_of(static_cast<uint8_t>(code - 1))) << code;
}

TEST(Container, SerializedHeadersParseBack) {
    Header h = small_header(), back;
    h.coding = Coding::kLossy;
    h.quantizer = 3.25f;
    h.tangential = 24;
    h.cell_area = 75;
    const auto bytes = serialize_header(h, kChunks);
    ASSERT_EQ(parse(bytes, &back), Status::kOk);
    EXPECT_EQ(back.index_size, bytes.size());
    EXPECT_EQ(back.quantizer, 3.25f);
    EXPECT_EQ(back.tangential, 24);
    EXPECT_EQ(back.cell_area, 75);
    EXPECT_EQ(back.origin, h.origin);
    EXPECT_EQ(back.level_count, 2u);
    EXPECT_EQ(back.sample_count, 33u * 33u);
}

// Kind 0x10; then a binary64 origin of 1, -2, 2^100; step 0.5.
std::vector<uint8_t> wide_bytes() {
    std::vector<uint8_t> bytes = {0x89, 'G', 'I',  'M',  0x0D, 0x0A, 0x1A, 1,    0, 0x10, 12, 1, 1, 2,  //
                                  0,    0,   0,    0,    0,    0,    0xF0, 0x3F,                        // 1
                                  0,    0,   0,    0,    0,    0,    0,    0xC0,                        // -2
                                  0,    0,   0,    0,    0,    0,    0x30, 0x46,                        // 2^100
                                  0,    0,   0,    0x3F,                                                // step
                                  0x00, 1,   0xAA, 0xBB, 0x04, 2,    0xCC, 0xDD};                       // SEAM, LEVL
    bytes[8] = static_cast<uint8_t>(bytes.size() + 4);
    append_u32(crc32(bytes), &bytes);
    return bytes;
}

TEST(Container, ABinary64OriginStandsInThePlaceOfTheOther) {
    Header h;
    ASSERT_EQ(parse(wide_bytes(), &h), Status::kOk);
    ASSERT_TRUE(h.wide_origin);
    EXPECT_EQ(*h.wide_origin, (std::array<double, 3>{1, -2, 0x1p100}));
    EXPECT_EQ(h.origin, (std::array<float, 3>{0, 0, 0}));
    EXPECT_EQ(h.step, 0.5f);
    EXPECT_EQ(h.chunk_count, 2u);

    h = small_header();
    h.wide_origin = {0.1, -1e30, 4e6 + 0.3};
    Header back;
    ASSERT_EQ(parse(serialize_header(h, kChunks), &back), Status::kOk);
    EXPECT_EQ(back.wide_origin, h.wide_origin);
    EXPECT_EQ(serialize_header(h, kChunks).size(), serialize_header(small_header(), kChunks).size() + 12);
    ASSERT_EQ(parse(serialize_header(small_header(), kChunks), &back), Status::kOk);
    EXPECT_FALSE(back.wide_origin);
}

TEST(Container, Binary64OriginsAreFiniteAndInRange) {
    Header back;
    const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1.3e30,
                          -1.3e30};
    for (size_t axis = 0; axis < 3; ++axis) {
        for (const double value : bad) {
            Header h = small_header();
            h.wide_origin = {0, 0, 0};
            (*h.wide_origin)[axis] = value;
            EXPECT_EQ(parse(serialize_header(h, kChunks), &back), Status::kMalformed) << axis << " " << value;
        }
    }
}

TEST(Container, IndicesThatEndWithinABinary64OriginAreMalformed) {
    const std::vector<uint8_t> whole = wide_bytes();
    for (size_t size = 14; size < 14 + 24; ++size) {
        std::vector<uint8_t> bytes(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size));
        bytes[8] = static_cast<uint8_t>(size + 4);
        append_u32(crc32(bytes), &bytes);
        Header h;
        EXPECT_EQ(parse(bytes, &h), Status::kMalformed) << size;
    }
}

TEST(Container, IndexSizeCountsItselfWhenItTakesTwoBytes) {
    const std::vector<uint8_t> sides(500, 5);
    Header h = small_header(), back;
    for (size_t count = 50; count < 200; ++count) {
        h.side_exponents = std::span(sides).first(count);
        const auto bytes = serialize_header(h, kChunks);
        ASSERT_EQ(parse(bytes, &back), Status::kOk) << count;
        EXPECT_EQ(back.index_size, bytes.size());
    }
}

TEST(Container, ErrorsOfLevelsAndBoxesOfImagesComeBack) {
    Header h = small_header(), back;
    const std::vector<uint8_t> errors = {200, 210, 180, 195};
    const std::vector<uint8_t> box = {0x40, 0x20, 0x10, 0x0C, 0x06, 0x03, 0xFC};
    h.level_errors = errors;
    h.boxes = box;
    const auto bytes = serialize_header(h, kChunks);
    ASSERT_EQ(parse(bytes, &back), Status::kOk);
    EXPECT_EQ(std::vector<uint8_t>(back.level_errors.begin(), back.level_errors.end()), errors);
    EXPECT_EQ(std::vector<uint8_t>(back.boxes.begin(), back.boxes.end()), box);
    EXPECT_EQ(back.chunk_count, 3u);
    h.level_errors = h.boxes = {};
    EXPECT_EQ(serialize_header(h, kChunks).size() + errors.size() + box.size(), bytes.size());
}

TEST(Container, EveryTruncationAsksForMore) {
    Header h;
    for (const auto& bytes : {serialize_header(small_header(), kChunks), wide_bytes()}) {
        for (size_t n = 0; n < bytes.size(); ++n) {
            const std::vector<uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(n));
            EXPECT_EQ(parse(cut, &h), Status::kNeedMoreInput) << n;
        }
    }
}

TEST(Container, IndexSizeWithASuperfluousZeroByteIsMalformedWhateverFollows) {
    Header h;
    std::vector<uint8_t> bytes(kMagic.begin(), kMagic.end());
    bytes.insert(bytes.end(), {kFormatVersion, 0xC0});
    EXPECT_EQ(parse(bytes, &h), Status::kNeedMoreInput);
    bytes.push_back(0x00);
    EXPECT_EQ(parse(bytes, &h), Status::kMalformed);
    bytes.resize(100);
    EXPECT_EQ(parse(bytes, &h), Status::kMalformed);
}

TEST(Container, EveryBitFlipIsNoticed) {
    const auto bytes = serialize_header(small_header(), kChunks);
    Header h;
    for (size_t bit = 0; bit < bytes.size() * 8; ++bit) {
        std::vector<uint8_t> flipped = bytes;
        flipped[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
        const Status s = parse(flipped, &h);
        if (bit / 8 < 7) {
            EXPECT_EQ(s, Status::kNotGim);
        } else if (bit / 8 == 7) {
            EXPECT_EQ(s, Status::kUnsupportedVersion);
        } else if (bit / 8 ==
                   8) {  // Index_Size: too small, too large for these bytes, or the wrong place for the checksum
            EXPECT_TRUE(s == Status::kMalformed || s == Status::kNeedMoreInput || s == Status::kChecksum);
        } else {
            EXPECT_EQ(s, Status::kChecksum) << bit;
        }
    }
}

TEST(Container, EveryByteValueOfASignedBodyIsParsedOrRefused) {
    const auto bytes = serialize_header(small_header(), kChunks);
    Header h;
    for (size_t at = 9; at + 4 < bytes.size(); ++at) {
        for (uint32_t value = 0; value < 256; ++value) {
            std::vector<uint8_t> changed = bytes;
            changed[at] = static_cast<uint8_t>(value);
            const Status s = parse(signed_again(changed), &h);
            EXPECT_TRUE(s == Status::kOk || s == Status::kMalformed || s == Status::kUnsupportedVersion ||
                        s == Status::kLimitExceeded)
                << at << " " << value;
        }
    }
}

TEST(Container, LimitsAreTheCallers) {
    Header h = small_header(), back;
    const auto bytes = serialize_header(h, kChunks);
    EXPECT_EQ(parse(bytes, &back, {33 * 33, 1, 33}), Status::kOk);
    EXPECT_EQ(parse(bytes, &back, {33 * 33 - 1, 1, 33}), Status::kLimitExceeded);
    EXPECT_EQ(parse(bytes, &back, {33 * 33, 0, 33}), Status::kLimitExceeded);
    EXPECT_EQ(parse(bytes, &back, {33 * 33, 1, 32}), Status::kLimitExceeded);
}

TEST(Container, UnknownChunksAreSkippedOnlyWhenOptional) {
    Header back;
    auto chunks = kChunks;
    chunks.insert(chunks.begin() + 1, chunk(static_cast<ChunkType>(77), 5, true));
    EXPECT_EQ(parse(serialize_header(small_header(), chunks), &back), Status::kOk);
    chunks[1].optional = false;
    EXPECT_EQ(parse(serialize_header(small_header(), chunks), &back), Status::kUnsupportedVersion);
}

TEST(Container, PayloadsAreCheckedAgainstTheirSum) {
    const std::vector<uint8_t> file = {1, 2, 3, 4, 5};
    Chunk c = chunk(ChunkType::kLevel, 3);
    c.crc = crc16(std::span(file).subspan(1, 3));
    std::span<const uint8_t> payload;
    EXPECT_EQ(read_payload(file, c, 1, &payload), Status::kOk);
    EXPECT_EQ(payload.size(), 3u);
    EXPECT_EQ(read_payload(file, c, 2, &payload), Status::kChecksum);
    EXPECT_EQ(read_payload(file, c, 3, &payload), Status::kNeedMoreInput);
    EXPECT_EQ(read_payload(file, c, UINT64_MAX, &payload), Status::kNeedMoreInput);
    c.size = UINT64_MAX;
    EXPECT_EQ(read_payload(file, c, 2, &payload), Status::kNeedMoreInput);
}

TEST(Leb128, SuperfluousBytesAndEndlessOnesAreRefused) {
    const auto read = [](std::vector<uint8_t> bytes, uint64_t* value) { return ByteReader(bytes).read_leb128(value); };
    uint64_t v = 0;
    EXPECT_TRUE(read({0}, &v));
    EXPECT_TRUE(read({0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x7F}, &v));
    EXPECT_EQ(v, (uint64_t{1} << 42) - 1);
    EXPECT_FALSE(read({0x80, 0x00}, &v));
    EXPECT_FALSE(read({0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x01}, &v));
    EXPECT_FALSE(read({0x80}, &v));
    EXPECT_FALSE(read({}, &v));
    for (const uint64_t value :
         {uint64_t{0}, uint64_t{127}, uint64_t{128}, uint64_t{300000}, (uint64_t{1} << 42) - 1}) {
        std::vector<uint8_t> bytes;
        append_leb128(value, &bytes);
        ASSERT_TRUE(read(bytes, &v));
        EXPECT_EQ(v, value);
    }
}

}  // namespace
}  // namespace gim

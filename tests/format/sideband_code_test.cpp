#include "format/sideband_code.h"

#include <gtest/gtest.h>

#include <array>

#include "format/seam.h"
#include "tests/format/random_sideband.h"

namespace gim {
namespace {

using test::Random;
using test::random_sideband;

Status parse(const std::vector<uint8_t>& bytes, Sideband* out, size_t* size = nullptr) {
    std::array<CutPath, kMaxCutPaths> paths;
    ParsedSideband parsed;
    const Status status = parse_sideband(bytes, paths, &parsed);
    if (status != Status::kOk) return status;
    *out = {parsed.node_side, parsed.start, {paths.begin(), paths.begin() + parsed.path_count}};
    if (size) *size = parsed.size;
    return status;
}

// The ring of the authors' bunny: four leaves, two branch nodes (all even, so it is stored on the grid of side 129).
Sideband bunny() {
    return {257, 16, {{1, 184}, {0, 184}, {3, 144}, {2, 144}, {9, 20}, {6, 72}, {5, 72}, {8, 92}, {7, 92}, {4, 20}}};
}

TEST(SidebandCode, OpenSquareIsOneByte) {
    std::vector<uint8_t> bytes;
    append_sideband(Sideband{2, 0, {}}, &bytes);
    EXPECT_EQ(bytes, std::vector<uint8_t>{0});
    Sideband back;
    ASSERT_EQ(parse(bytes, &back), Status::kOk);
    EXPECT_TRUE(back.paths.empty());
}

TEST(SidebandCode, HandWrittenBytesDecode) {
    // 0011: side 9. 00100: start 4 of 0..31. 01 1111: a new path, 15 + 1 of 1..16 long. 1: its mate.
    const std::vector<uint8_t> bytes = {0b00110010, 0b00111111};
    Sideband back;
    ASSERT_EQ(parse(bytes, &back), Status::kOk);
    EXPECT_EQ(back, (Sideband{9, 4, {{1, 16}, {0, 16}}}));
    std::vector<uint8_t> again;
    append_sideband(back, &again);
    EXPECT_EQ(again, bytes);
}

TEST(SidebandCode, PathsOnTheSmallestGridAreStoredOnTheNext) {
    const Sideband smallest{2, 1, {{1, 2}, {0, 2}}};
    const Sideband stored = with_coarsest_node_grid(smallest);
    EXPECT_EQ(stored, (Sideband{3, 2, {{1, 4}, {0, 4}}}));
    std::vector<uint8_t> bytes;
    append_sideband(stored, &bytes);
    Sideband back;
    ASSERT_EQ(parse(bytes, &back), Status::kOk);
    EXPECT_EQ(back, stored);
}

TEST(SidebandCode, BunnyTakesADozenBytes) {
    std::vector<uint8_t> bytes;
    append_sideband(with_coarsest_node_grid(bunny()), &bytes);
    EXPECT_LE(bytes.size(), 12u);
    Sideband back;
    ASSERT_EQ(parse(bytes, &back), Status::kOk);
    EXPECT_EQ(back.node_side, 65u);  // 4 divides all positions
    EXPECT_EQ(back.paths[0].length, 184u / 4);
}

TEST(SidebandCode, RandomSchemasRoundTripAndEveryTruncationIsRefused) {
    Random random(7);
    for (int round = 0; round < 2000; ++round) {
        const uint32_t node_side = (2u << random.below(7)) + 1;
        const uint32_t room = ring_length(node_side);
        const uint32_t pairs = random.below(std::min(room / 2, 40u) + 1);
        const uint32_t open = random.below(std::min(room - 2 * pairs, 20u) + 1);
        if (2 * pairs + open == 0) continue;
        const Sideband s = random_sideband(random, node_side, pairs, open, random.below(2) == 0);
        std::vector<uint8_t> bytes;
        append_sideband(s, &bytes);
        const size_t size = bytes.size();
        bytes.push_back(0xFF);  // the next image's
        Sideband back;
        size_t used = 0;
        ASSERT_EQ(parse(bytes, &back, &used), Status::kOk);
        ASSERT_EQ(back, s);
        ASSERT_EQ(used, size);
        for (size_t n = 0; n < size; ++n) {
            ASSERT_EQ(parse({bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(n)}, &back), Status::kMalformed);
        }
    }
}

TEST(SidebandCode, EveryBitFlipIsRefusedOrGivesAnotherValidSideband) {
    std::vector<uint8_t> bytes;
    append_sideband(bunny(), &bytes);
    for (size_t bit = 0; bit < bytes.size() * 8; ++bit) {
        std::vector<uint8_t> flipped = bytes;
        flipped[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
        Sideband back;
        SeamTable table;
        if (parse(flipped, &back) != Status::kOk) continue;
        EXPECT_NE(back, bunny());
        EXPECT_EQ(build_seam_table(back, &table), Status::kOk);
    }
}

TEST(SidebandCode, MatesWithoutOpenPathsAndPaddingAreRefused) {
    Sideband back;
    EXPECT_EQ(parse({0b00110010, 0b01000000, 0, 0}, &back), Status::kMalformed);  // a mate first
    EXPECT_EQ(parse({0b11110000, 0, 0, 0}, &back), Status::kMalformed);           // side 2^15+1
    EXPECT_EQ(parse({0b00000001}, &back), Status::kMalformed);
}

TEST(SidebandCode, CoarsestNodeGridKeepsTheNodes) {
    const Sideband coarse = with_coarsest_node_grid({17, 8, {{1, 32}, {0, 32}}});
    EXPECT_EQ(coarse, (Sideband{3, 1, {{1, 4}, {0, 4}}}));
    EXPECT_EQ(with_coarsest_node_grid(coarse), coarse);
}

}  // namespace
}  // namespace gim

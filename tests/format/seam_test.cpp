#include "format/seam.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "tests/format/random_sideband.h"

namespace gim {
namespace {

Status build(const Sideband& s) {
    SeamTable table;
    return build_seam_table(s, &table);
}

TEST(SeamTable, RefusesInconsistentSidebands) {
    EXPECT_EQ(build({9, 4, {{1, 16}, {0, 16}}}), Status::kOk);
    EXPECT_EQ(build({8, 4, {{1, 14}, {0, 14}}}), Status::kMalformed);         // not 2^j+1
    EXPECT_EQ(build({9, 32, {{1, 16}, {0, 16}}}), Status::kMalformed);        // start outside
    EXPECT_EQ(build({9, 4, {{1, 15}, {0, 15}}}), Status::kMalformed);         // ring not filled
    EXPECT_EQ(build({9, 4, {{1, 17}, {0, 17}}}), Status::kMalformed);         // ring overfilled
    EXPECT_EQ(build({9, 4, {{1, 15}, {0, 17}}}), Status::kMalformed);         // unequal mates
    EXPECT_EQ(build({9, 4, {{0, 32}}}), Status::kMalformed);                  // its own mate
    EXPECT_EQ(build({9, 4, {{1, 8}, {2, 8}, {0, 16}}}), Status::kMalformed);  // not mutual
    EXPECT_EQ(build({9, 4, {{5, 16}, {0, 16}}}), Status::kMalformed);         // no such path
    EXPECT_EQ(build({9, 4, {{1, 0}, {0, 0}, {kNoMate, 32}}}), Status::kMalformed);
    EXPECT_EQ(build({9, 4, {{kNoMate, UINT32_MAX}, {kNoMate, 33}}}), Status::kMalformed);  // sum wraps
    EXPECT_EQ(build({9, 4, {{kNoMate, 32}}}), Status::kOk);
}

TEST(RingClasses, MatesRunInOppositeDirections) {
    SeamTable table;
    ASSERT_EQ(build_seam_table(Sideband{9, 4, {{1, 16}, {0, 16}}}, &table), Status::kOk);
    std::vector<uint32_t> c(ring_length(17));
    ring_classes(table, 17, c);
    // Leaves at ring samples 8 and 40 of 64.
    for (uint32_t t = 1; t < 32; ++t) EXPECT_EQ(c[(8 + t) % 64], c[(8 + 64 - t) % 64]) << t;
    EXPECT_EQ(ring_class_count(table, 17), 33u);
    EXPECT_EQ(table.node_class_count, 2u);
}

TEST(RingClasses, TorusHasOneNode) {
    SeamTable table;  // a b a' b'
    ASSERT_EQ(build_seam_table(Sideband{5, 0, {{2, 4}, {3, 4}, {0, 4}, {1, 4}}}, &table), Status::kOk);
    EXPECT_EQ(table.node_class_count, 1u);
    EXPECT_EQ(ring_class_count(table, 5), 7u);
    std::vector<uint32_t> c(16);
    ring_classes(table, 5, c);
    EXPECT_EQ(c, (std::vector<uint32_t>{0, 1, 2, 3, 0, 4, 5, 6, 0, 3, 2, 1, 0, 6, 5, 4}));
}

// Applies the definition step by step: a union-find over samples glues the edges of mates one by one.
TEST(RingClasses, AgreeWithGluingEdgeByEdge) {
    test::Random random(11);
    for (int round = 0; round < 2000; ++round) {
        const uint32_t node_side = (2u << random.below(4)) + 1;
        const uint32_t room = ring_length(node_side);
        const uint32_t pairs = random.below(std::min(room / 2, 12u) + 1);
        const uint32_t open = random.below(std::min(room - 2 * pairs, 5u) + 1);
        if (2 * pairs + open == 0) continue;
        const Sideband s = test::random_sideband(random, node_side, pairs, open, false);
        SeamTable table;
        ASSERT_EQ(build_seam_table(s, &table), Status::kOk);
        const uint32_t scale = 1u << random.below(3), side = (node_side - 1) * scale + 1, ring = ring_length(side);
        std::vector<uint32_t> parent(ring);
        std::iota(parent.begin(), parent.end(), 0u);
        const auto root = [&](uint32_t k) {
            while (parent[k] != k) k = parent[k];
            return k;
        };
        std::vector<uint32_t> begin = {s.start * scale};
        for (const CutPath& p : s.paths) begin.push_back(begin.back() + p.length * scale);
        for (size_t i = 0; i < s.paths.size(); ++i) {
            if (s.paths[i].mate == kNoMate) continue;
            const uint32_t end = begin[static_cast<size_t>(s.paths[i].mate) + 1];
            for (uint32_t t = 0; t <= s.paths[i].length * scale; ++t) {
                const uint32_t a = root((begin[i] + t) % ring), b = root((end - t) % ring);
                parent[std::max(a, b)] = std::min(a, b);
            }
        }
        std::vector<uint32_t> expected(ring), got(ring);
        uint32_t count = 0;
        for (uint32_t k = 0; k < ring; ++k) expected[k] = root(k) == k ? count++ : expected[root(k)];
        ring_classes(table, side, got);
        ASSERT_EQ(got, expected);
        ASSERT_EQ(ring_class_count(table, side), count);
    }
}

TEST(LevelIsClosed, NeedsTheNodesOnItsGrid) {
    SeamTable table;
    ASSERT_EQ(build_seam_table(Sideband{17, 3, {{1, 32}, {0, 32}}}, &table), Status::kOk);
    EXPECT_TRUE(level_is_closed(table, 17));
    EXPECT_TRUE(level_is_closed(table, 257));
    EXPECT_FALSE(level_is_closed(table, 9));
    EXPECT_FALSE(level_is_closed(table, 18));
}

TEST(LevelIsClosed, AcceptsSingleEdgePathsBetweenDifferentNodes) {
    // A tree whose trunk is one edge long at the node grid.
    const Sideband s = {9, 4, {{1, 6}, {0, 6}, {5, 1}, {4, 9}, {3, 9}, {2, 1}}};
    SeamTable table;
    ASSERT_EQ(build_seam_table(s, &table), Status::kOk);
    EXPECT_TRUE(level_is_closed(table, 9));
}

TEST(Ring, PointAndIndexAreInverse) {
    for (uint32_t k = 0; k < ring_length(9); ++k) {
        const GridPoint p = ring_point(9, k);
        EXPECT_TRUE(on_rim(9, p.row, p.column));
        EXPECT_EQ(ring_index(9, p.row, p.column), k);
    }
}

}  // namespace
}  // namespace gim

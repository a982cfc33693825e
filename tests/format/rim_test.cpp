#include "format/rim.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/format/random_sideband.h"

namespace gim {
namespace {

using test::Random;
using test::random_sideband;

SeamTable table_of(const Sideband& sideband) {
    SeamTable table;
    EXPECT_EQ(build_seam_table(sideband, &table), Status::kOk);
    return table;
}

std::vector<uint32_t> sources(const SeamTable& seams, uint32_t side) {
    std::vector<uint32_t> source(ring_length(side));
    rim_sources(seams, side, source);
    return source;
}

// Place of a rim detail in the stream: all of the horizontal band, then the vertical one, row by row.
uint64_t place_in_stream(const DetailPlace& place) {
    return (uint64_t{place.orientation == Orientation::kVertical} << 40) + (uint64_t{place.row} << 20) + place.column;
}

TEST(Rim, TorusByHand) {
    const SeamTable torus = table_of({2, 0, {{2, 1}, {3, 1}, {0, 1}, {1, 1}}});
    // Top and bottom rows run in opposite directions; so do left and right columns, of which the left one is stored.
    const uint32_t n = kRunEnd;
    EXPECT_EQ(sources(torus, 5), (std::vector<uint32_t>{n, 1, 2, 3, n, 15, 6, 13, n, 3, 10, 1, n, 13, 14, 15}));
    EXPECT_EQ(sources(torus, 3), (std::vector<uint32_t>{n, 1, n, 7, n, 1, n, 7}));
    EXPECT_EQ(sources(torus, 2), (std::vector<uint32_t>{0, 1, 2, 3})) << "the node grid itself";
}

TEST(Rim, BoundariesAndOpenSquaresShareNothing) {
    const SeamTable boundary = table_of({2, 0, {{kNoMate, 4}}}), open = table_of({2, 0, {}});
    const std::vector<uint32_t> of_boundary = sources(boundary, 9), of_open = sources(open, 9);
    EXPECT_EQ(of_boundary[0], kRunEnd);
    for (uint32_t k = 1; k < ring_length(9); ++k) EXPECT_EQ(of_boundary[k], k);
    for (uint32_t k = 0; k < ring_length(9); ++k) EXPECT_EQ(of_open[k], k);
}

TEST(Rim, MatesShareOneDetailAndItIsTheFirstInTheStream) {
    Random random(5);
    for (int round = 0; round < 200; ++round) {
        const uint32_t node_side = (1u << (1 + random.below(4))) + 1, most = ring_length(node_side) / 2;
        const uint32_t pairs = 1 + random.below(most), open = random.below(ring_length(node_side) - 2 * pairs + 1);
        const SeamTable seams = table_of(random_sideband(random, node_side, pairs, open, random.below(2) == 0));
        const uint32_t side = (node_side - 1) * (2u << random.below(3)) + 1;
        const std::vector<uint32_t> source = sources(seams, side);
        std::vector<uint32_t> classes(ring_length(side)), members(ring_length(side)), stored(ring_length(side));
        ring_classes(seams, side, classes);
        for (uint32_t k = 1; k < source.size(); k += 2) {
            ++members[classes[k]];
            stored[classes[k]] += source[k] == k;
            ASSERT_EQ(classes[source[k]], classes[k]);
            ASSERT_EQ(source[source[k]], source[k]);
        }
        for (uint32_t k = 1; k < source.size(); k += 2) {
            ASSERT_LE(members[classes[k]], 2u);
            ASSERT_EQ(stored[classes[k]], 1u);
        }
        const SharedRim rim(source.data(), side);
        uint32_t copies = 0;
        rim.for_each_copy([&](Orientation orientation, uint32_t row, uint32_t column) {
            ++copies;
            const DetailPlace from = rim.source_of(orientation, row, column);
            EXPECT_TRUE(rim.is_copy(orientation, row, column));
            EXPECT_FALSE(rim.is_copy(from.orientation, from.row, from.column));
            EXPECT_LT(place_in_stream(from), place_in_stream({orientation, row, column}));
        });
        EXPECT_GT(copies, 0u);
        EXPECT_FALSE(rim.is_copy(Orientation::kDiagonal, 0, 0));
        // Runs end at cut-nodes, and at samples whose mate is a corner of the square.
        for (uint32_t k = 0; k < source.size(); k += 2) {
            bool is_end = false;
            for (uint32_t path = 0; path < seams.path_count; ++path)
                is_end |= seams.first[path] * ((side - 1) / (node_side - 1)) % ring_length(side) == k;
            for (uint32_t corner = 0; corner < ring_length(side); corner += side - 1)
                is_end |= corner != k && classes[corner] == classes[k];
            EXPECT_EQ(source[k] == kRunEnd, is_end);
        }
    }
}

}  // namespace
}  // namespace gim

#include "encoder/squares/share_sides.h"

#include <gtest/gtest.h>

#include <numeric>

namespace gim {
namespace {

uint64_t samples(const std::vector<uint32_t>& sides) {
    return std::accumulate(sides.begin(), sides.end(), uint64_t{0},
                           [](uint64_t sum, uint32_t side) { return sum + uint64_t{side} * side; });
}

TEST(ShareSides, OneComponentGetsAll) {
    for (const uint32_t side : {5u, 9u, 17u, 257u, 4097u}) {
        EXPECT_EQ(share_sides(std::vector<double>{3}, side), std::vector<uint32_t>{side});
        EXPECT_EQ(share_sides(std::vector<double>{0}, side), std::vector<uint32_t>{side});
    }
}

TEST(ShareSides, TogetherTheyHaveAboutAsManySamplesAsOne) {
    for (const std::vector<double>& areas :
         {std::vector<double>{100, 7, 7, 1, 0.2, 0, 40}, {1, 1}, {1, 1, 1}, {5, 1, 1, 1, 1, 1}, {0.9, 0.05, 0.05}}) {
        for (const uint32_t side : {65u, 129u, 257u, 1025u}) {
            const std::vector<uint32_t> sides = share_sides(areas, side);
            const uint64_t least = 25 * areas.size();
            EXPECT_LE(samples(sides), uint64_t{side} * side * 6 / 5 + least);
            EXPECT_GT(3 * samples(sides), uint64_t{side} * side);
            for (size_t i = 0; i < areas.size(); ++i) {
                EXPECT_GE(sides[i], 5u);
                for (size_t k = 0; k < areas.size(); ++k) {
                    EXPECT_TRUE(areas[i] <= areas[k] || sides[i] >= sides[k]) << i << " " << k;
                }
            }
        }
    }
}

TEST(ShareSides, EqualPartsAreServedInOrder) {
    EXPECT_EQ(share_sides(std::vector<double>(4, 1.0), 257), std::vector<uint32_t>(4, 129));
    EXPECT_EQ(share_sides(std::vector<double>(5, 1.0), 257), (std::vector<uint32_t>{129, 129, 129, 65, 65}));
}

TEST(ShareSides, SpecksDoNotHalveTheLargePart) {
    EXPECT_EQ(share_sides(std::vector<double>{0.9, 0.001, 0.001}, 257), (std::vector<uint32_t>{257, 9, 9}));
}

TEST(ShareSides, ManyPartsHaveTheLeastSide) {
    const std::vector<uint32_t> sides = share_sides(std::vector<double>(5000, 1.0), 257);
    EXPECT_EQ(sides, std::vector<uint32_t>(5000, 5));
}

}  // namespace
}  // namespace gim

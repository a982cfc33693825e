#include "encoder/code/next_quantizer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace gim {
namespace {

struct Found {
    double octave = 0;
    int files = 0;
};

// Searches until the room is less than 0.01 octaves. room: of a quantizer, by its base-2 logarithm.
Found found(double first, double most_step, const std::function<double(double)>& room) {
    NextQuantizer next(most_step);
    double quantizer = std::exp2(first);
    Found result{first, 0};
    while (result.files < 30) {
        result.octave = std::log2(quantizer);
        ++result.files;
        const double now = room(result.octave);
        if (std::abs(now) < 0.01) break;
        quantizer = next.after(quantizer, now);
    }
    return result;
}

TEST(NextQuantizer, UsualFilesTakeTwoTries) {
    for (const double first : {1.0, 4.9, 8.0}) {
        const Found result = found(first, 10, [](double octave) { return 5 - octave; });
        EXPECT_NEAR(result.octave, 5, 0.01) << first;
        EXPECT_EQ(result.files, 2) << first;
    }
}

TEST(NextQuantizer, FlatAndSteepFilesTakeFew) {
    for (const double slope : {0.3, 0.6, 1.5, 4.0}) {
        const Found result = found(2, 2, [&](double octave) { return slope * (5 - octave); });
        EXPECT_NEAR(result.octave, 5, 0.04) << slope;
        EXPECT_LE(result.files, 9) << slope;
    }
}

TEST(NextQuantizer, StepsAreNoLongerThanAllowed) {
    NextQuantizer next(2);
    EXPECT_NEAR(std::log2(next.after(16, -7)), 2, 1e-9);
    EXPECT_NEAR(std::log2(next.after(16, 7)), 6, 1e-9);
}

TEST(NextQuantizer, TheSlopeIsThatOfTheLastTwoFiles) {
    NextQuantizer next(4);
    next.after(16, -1);
    EXPECT_FALSE(next.slope().has_value());
    next.after(8, -0.9);
    ASSERT_TRUE(next.slope().has_value());
    EXPECT_NEAR(*next.slope(), 0.1, 1e-9);
    next.after(8 * 1.001, -0.5);  // as good as the same quantizer
    EXPECT_FALSE(next.slope().has_value());
    next.after(4, -0.2);
    EXPECT_NEAR(*next.slope(), 0.3, 1e-2);
}

}  // namespace
}  // namespace gim

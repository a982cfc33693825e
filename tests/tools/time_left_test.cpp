#include "tools/time_left.h"

#include <gtest/gtest.h>

namespace gim {
namespace {

TEST(TimeLeft, TheRestTakesAsLongAsThePartBefore) {
    TimeLeft left;
    EXPECT_FALSE(left.update(0, 100));
    EXPECT_FALSE(left.update(0.5, 101)) << "a second tells nothing";
    EXPECT_FALSE(TimeLeft().update(0.9, 50)) << "it has just begun";
    EXPECT_NEAR(left.update(0.6, 112).value_or(-1), 8, 1e-9);
}

TEST(TimeLeft, WorkThatBeginsAnewIsEstimatedAnew) {
    TimeLeft left;
    left.update(0, 0);
    EXPECT_NEAR(left.update(0.5, 60).value_or(-1), 60, 1e-9);
    EXPECT_FALSE(left.update(0.1, 61));
    EXPECT_NEAR(left.update(0.4, 64).value_or(-1), 6, 1e-9);
    EXPECT_NEAR(left.update(1, 70).value_or(-1), 0, 1e-9);
}

TEST(TimeLeft, DurationsAreRoundedTheMoreTheLongerTheyAre) {
    EXPECT_EQ(duration_text(-1), "0 s");
    EXPECT_EQ(duration_text(0.6), "1 s");
    EXPECT_EQ(duration_text(59.4), "59 s");
    EXPECT_EQ(duration_text(59.6), "1 min");
    EXPECT_EQ(duration_text(131), "2 min 10 s");
    EXPECT_EQ(duration_text(3569), "59 min 30 s");
    EXPECT_EQ(duration_text(3599), "1 h");
    EXPECT_EQ(duration_text(3900), "1 h 5 min");
}

}  // namespace
}  // namespace gim

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gim/decoder.h"

namespace {

// Errors 0.001, 0.004, 0.016, ... of five levels.
gim_info five_levels() {
    gim_info info{};
    info.level_count = 5;
    for (int level = 0; level < 5; ++level) info.level_max_error[level] = std::ldexp(0.001f, 2 * level);
    return info;
}

// 90 degrees and 1000 pixels: at distance d a pixel covers d / 500.
gim_view view_from(float distance) { return {distance, std::acos(0.0f), 1000, 1}; }

TEST(ChooseLevel, TakesTheCoarsestWhoseErrorIsOnePixel) {
    const gim_info info = five_levels();
    for (uint32_t level = 0; level < 5; ++level) {
        const float distance = 500 * info.level_max_error[level];
        const gim_view near = view_from(0.99f * distance), far = view_from(1.01f * distance);
        EXPECT_EQ(gim_choose_level(&info, &far, GIM_NO_LEVEL), level);
        EXPECT_EQ(gim_choose_level(&info, &near, GIM_NO_LEVEL), level == 0 ? 0 : level - 1);
    }
}

TEST(ChooseLevel, AFinerLevelComesAtOnceACoarserOneLate) {
    const gim_info info = five_levels();
    const float limit = 500 * info.level_max_error[2];
    const gim_view nearer = view_from(0.99f * limit), farther = view_from(1.2f * limit), far = view_from(1.34f * limit);
    EXPECT_EQ(gim_choose_level(&info, &nearer, 2), 1u);
    EXPECT_EQ(gim_choose_level(&info, &farther, 1), 1u);
    EXPECT_EQ(gim_choose_level(&info, &farther, 2), 2u);
    EXPECT_EQ(gim_choose_level(&info, &farther, GIM_NO_LEVEL), 2u);
    EXPECT_EQ(gim_choose_level(&info, &far, 1), 2u);
}

TEST(ChooseLevel, AnEyeThatMovesALittleNeverSwitchesBack) {
    const gim_info info = five_levels();
    const float limit = 500 * info.level_max_error[3];
    uint32_t shown = GIM_NO_LEVEL, switches = 0;
    for (int frame = 0; frame < 200; ++frame) {
        const gim_view view = view_from(limit * (1 + 0.1f * std::sin(static_cast<float>(frame))));
        const uint32_t level = gim_choose_level(&info, &view, shown);
        switches += level != shown ? 1 : 0;
        shown = level;
    }
    EXPECT_LE(switches, 2u);  // the first, and one to the finer level
}

TEST(ChooseLevel, WiderViewsAndSmallerScreensTakeCoarserLevels) {
    const gim_info info = five_levels();
    gim_view view = view_from(1);
    const uint32_t plain = gim_choose_level(&info, &view, GIM_NO_LEVEL);
    view.viewport_height = 100;
    EXPECT_GT(gim_choose_level(&info, &view, GIM_NO_LEVEL), plain);
    view = view_from(1);
    view.vertical_fov = 3;
    EXPECT_GT(gim_choose_level(&info, &view, GIM_NO_LEVEL), plain);
    view = view_from(1);
    view.pixel_error = 10;
    EXPECT_GT(gim_choose_level(&info, &view, GIM_NO_LEVEL), plain);
}

TEST(ChooseLevel, LevelsWithoutAToldErrorAreNotChosen) {
    gim_info info = five_levels();
    info.level_max_error[4] = info.level_max_error[3] = 0;
    const gim_view far = view_from(1e9f);
    EXPECT_EQ(gim_choose_level(&info, &far, GIM_NO_LEVEL), 2u);
    gim_info silent{};
    silent.level_count = 5;
    EXPECT_EQ(gim_choose_level(&silent, &far, GIM_NO_LEVEL), 0u);
}

TEST(ChooseLevel, ViewsThatMakeNoSenseGetTheFinest) {
    const gim_info info = five_levels();
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    for (const gim_view view :
         {gim_view{0, 1, 1000, 1}, gim_view{-5, 1, 1000, 1}, gim_view{kNaN, 1, 1000, 1}, gim_view{5, kNaN, 1000, 1},
          gim_view{5, 1, kNaN, 1}, gim_view{5, 1, 1000, kNaN}, gim_view{5, 1, 1000, 0}, gim_view{5, 1, 1000, -1}})
        EXPECT_EQ(gim_choose_level(&info, &view, 3), 0u);
    EXPECT_EQ(gim_choose_level(&info, nullptr, 3), 0u);
    EXPECT_EQ(gim_choose_level(nullptr, nullptr, 3), 0u);
}

}  // namespace

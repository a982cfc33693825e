#include "format/chart_ramp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace gim {
namespace {

// A box whose defined samples are a rectangle with a margin of undefined ones around it.
struct Box {
    uint32_t columns, rows, margin;
    std::vector<uint8_t> depth;
    std::vector<float> corrections, samples;
    std::vector<uint32_t> border;

    Box(uint32_t width, uint32_t height, uint32_t around)
        : columns(width + 2 * around), rows(height + 2 * around), margin(around) {
        depth.assign(size_t{columns} * rows, kUndefined);
        for (uint32_t row = 0; row < rows; ++row) {
            for (uint32_t column = 0; column < columns; ++column) {
                if (steps_inside(row, column) < 0) continue;
                depth[row * columns + column] = steps_inside(row, column) == 0 ? kOnBorder : kInside;
                if (steps_inside(row, column) == 0) border.push_back(row * columns + column);
            }
        }
        corrections.assign(3 * depth.size(), 0.0f);
        samples.assign(3 * depth.size(), 0.0f);
    }
    // Steps to the border; negative outside.
    int steps_inside(uint32_t row, uint32_t column) const {
        const auto inside = [this](uint32_t at, uint32_t count) {
            const int from_first = static_cast<int>(at) - static_cast<int>(margin);
            return std::min(from_first, static_cast<int>(count) - 1 - 2 * static_cast<int>(margin) - from_first);
        };
        return std::min(inside(row, rows), inside(column, columns));
    }
    void correct_border(float x, float y, float z) {
        for (const uint32_t i : border) {
            corrections[3 * i] = x, corrections[3 * i + 1] = y, corrections[3 * i + 2] = z;
            for (size_t k = 0; k < 3; ++k) samples[3 * i + k] = corrections[3 * i + k];
        }
    }
    void spread() {
        std::vector<uint32_t> queue(depth.size());
        spread_corrections({columns, rows, depth.data(), corrections.data(), samples.data()}, border, queue.data());
    }
};

TEST(ChartRamp, WidthIsAnEighthOfTheShorterSideWithinBounds) {
    EXPECT_EQ(chart_diffusion_width(3, 100), 2u);
    EXPECT_EQ(chart_diffusion_width(100, 40), 5u);
    EXPECT_EQ(chart_diffusion_width(40, 100), 5u);
    EXPECT_EQ(chart_diffusion_width(1000, 1000), 16u);
}

TEST(ChartRamp, CorrectionsFadeLayerByLayerAndEndAtTheWidth) {
    for (const uint32_t margin : {0u, 1u, 3u}) {
        Box box(44, 37, margin);
        box.correct_border(1, -2, 0);
        box.spread();
        const auto width = static_cast<int>(chart_diffusion_width(box.columns, box.rows));
        std::vector<float> of_layer(20, 0.0f);
        for (uint32_t row = 0; row < box.rows; ++row) {
            for (uint32_t column = 0; column < box.columns; ++column) {
                const uint32_t i = row * box.columns + column;
                const int layer = box.steps_inside(row, column);
                if (layer < 0) {
                    EXPECT_EQ(box.depth[i], kUndefined);
                }
                if (layer < 0 || layer > width) {
                    for (size_t k = 0; k < 3; ++k) EXPECT_EQ(box.samples[3 * i + k], 0.0f);
                    continue;
                }
                EXPECT_EQ(box.depth[i], layer);
                // All samples of a layer get the same, because all of the border did.
                float& first = of_layer[static_cast<size_t>(layer)];
                if (first == 0) first = box.samples[3 * i];
                EXPECT_NEAR(box.samples[3 * i], first, 1e-6f);
                EXPECT_NEAR(box.samples[3 * i + 1], -2 * first, 1e-6f);
                EXPECT_EQ(box.samples[3 * i + 2], 0.0f);
            }
        }
        for (size_t layer = 0; layer < static_cast<size_t>(width); ++layer)
            EXPECT_GT(of_layer[layer], of_layer[layer + 1]) << layer;
        EXPECT_GT(of_layer[static_cast<size_t>(width)], 0.0f);
    }
}

TEST(ChartRamp, ASingleCorrectionStaysAroundItsPlace) {
    Box box(40, 40, 0);
    const uint32_t at = 20;  // in the first row
    box.corrections[3 * at] = box.samples[3 * at] = 1;
    box.spread();
    for (uint32_t row = 0; row < box.rows; ++row) {
        for (uint32_t column = 0; column < box.columns; ++column) {
            const bool is_near = std::max(column, at) - std::min(column, at) <= row;
            const float moved = box.samples[3 * (row * box.columns + column)];
            if (!is_near) {
                EXPECT_EQ(moved, 0.0f) << row << ", " << column;
            }
            EXPECT_LE(moved, 1.0f);
        }
    }
    EXPECT_GT(box.samples[3 * (box.columns + at)], 0.1f);
}

}  // namespace
}  // namespace gim

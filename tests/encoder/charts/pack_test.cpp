#include "encoder/charts/pack.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gim {
namespace {

std::vector<Vec2> blob(int points, double inner, double outer, double stretch) {
    std::vector<Vec2> polygon;
    for (int i = 0; i < 2 * points; ++i) {
        const double radius = i % 2 ? inner : outer, angle = 3.14159265 * i / points;
        polygon.emplace_back(stretch * radius * std::cos(angle), radius * std::sin(angle));
    }
    return polygon;
}

std::vector<PackShape> some_shapes() {
    std::vector<PackShape> shapes;
    for (int i = 0; i < 14; ++i) shapes.push_back({blob(3 + i % 5, 0.6 + 0.03 * i, 1, 1 + 0.2 * (i % 4)), 8, 1});
    return shapes;
}

// Chart number per sample, kNone where undefined; fails the test on an overlap.
std::vector<uint32_t> painted(const Packing& packing) {
    std::vector<uint32_t> owner(size_t{packing.width} * packing.height, kNone);
    for (uint32_t c = 0; c < packing.charts.size(); ++c) {
        const PlacedChart& placed = packing.charts[c];
        const SampleMask& mask = placed.chart.mask;
        for (uint32_t y = 0; y < mask.height; ++y) {
            for (uint32_t x = 0; x < mask.width; ++x) {
                if (!mask.at(x, y)) continue;
                EXPECT_LT(placed.column + x, packing.width);
                EXPECT_LT(placed.row + y, packing.height);
                uint32_t& sample = owner[size_t{placed.row + y} * packing.width + placed.column + x];
                EXPECT_EQ(sample, kNone);
                sample = c;
            }
        }
    }
    return owner;
}

TEST(Pack, ChartsKeepApartInsideTheBound) {
    const std::vector<PackShape> shapes = some_shapes();
    for (const uint32_t samples : {3000u, 20000u}) {
        const auto packed = pack(shapes, {.most_samples = samples, .effort = 4});
        ASSERT_TRUE(packed.ok()) << packed.error().message;
        const Packing& packing = packed.value();
        ASSERT_TRUE(packing.broken.empty());
        EXPECT_LE(uint64_t{packing.width} * packing.height, samples);
        EXPECT_LT(std::max(packing.width, packing.height), 4 * std::min(packing.width, packing.height));
        const std::vector<uint32_t> owner = painted(packing);
        uint64_t defined = 0;
        for (uint32_t y = 0; y < packing.height; ++y) {
            for (uint32_t x = 0; x < packing.width; ++x) {
                const uint32_t own = owner[size_t{y} * packing.width + x];
                if (own == kNone) continue;
                ++defined;
                if (x > 0 && owner[size_t{y} * packing.width + x - 1] != kNone) {
                    EXPECT_EQ(owner[size_t{y} * packing.width + x - 1], own);
                }
                if (y > 0 && owner[size_t{y - 1} * packing.width + x] != kNone) {
                    EXPECT_EQ(owner[size_t{y - 1} * packing.width + x], own);
                }
            }
        }
        EXPECT_EQ(defined, packing.defined);
    }
}

TEST(Pack, EveryChartIsADiskWithEnoughBorderInItsPose) {
    std::vector<PackShape> shapes = some_shapes();
    shapes.push_back({blob(4, 0.02, 0.02, 1), 12, 1});  // would be a dot: has to grow for its border
    const auto packed = pack(shapes, {.most_samples = 8000, .effort = 2});
    ASSERT_TRUE(packed.ok());
    for (size_t c = 0; c < shapes.size(); ++c) {
        const PlacedChart& placed = packed.value().charts[c];
        EXPECT_TRUE(placed.chart.is_disk);
        EXPECT_GE(placed.chart.border_length, shapes[c].least_border);
        for (const Vec2& p : shapes[c].border) {
            const Vec2 q = placed.chart.pose(p) - Vec2(placed.column, placed.row);
            const auto x = static_cast<int64_t>(std::floor(q.x())), y = static_cast<int64_t>(std::floor(q.y()));
            const SampleMask& mask = placed.chart.mask;
            bool near = false;  // tips may be cut by a sample
            for (int64_t j = y - 1; j <= y + 2; ++j) {
                for (int64_t i = x - 1; i <= x + 2; ++i) near |= mask.at(i, j);
            }
            EXPECT_TRUE(near);
        }
    }
}

TEST(Pack, SquaresFillMostOfTheRectangle) {
    std::vector<PackShape> shapes;
    for (int i = 0; i < 16; ++i) shapes.push_back({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 4, 1});
    const auto packed = pack(shapes, {.most_samples = 20000, .effort = 5});
    ASSERT_TRUE(packed.ok());
    EXPECT_GT(packed.value().efficiency(), 0.9);
}

TEST(Pack, InletNarrowerThanASampleIsReported) {
    std::vector<Vec2> ring;
    for (int i = 0; i <= 60; ++i) ring.push_back(Vec2(std::cos(i * 0.1047), std::sin(i * 0.1047)));
    for (int i = 60; i >= 0; --i) ring.push_back(0.6 * Vec2(std::cos(i * 0.1047), std::sin(i * 0.1047)));
    std::vector<PackShape> shapes = some_shapes();
    shapes.push_back({ring, 4, 1});
    const auto packed = pack(shapes, {.most_samples = 5000, .effort = 1});
    ASSERT_TRUE(packed.ok());
    EXPECT_EQ(packed.value().broken, std::vector<uint32_t>{14});
}

TEST(Pack, ChartTooLongForTheRectangleIsReported) {
    std::vector<PackShape> shapes = some_shapes();
    shapes.push_back({{{0, 0}, {100, 0}, {100, 0.3}, {0, 0.3}}, 4, 1});
    const auto packed = pack(shapes, {.most_samples = 5000, .effort = 1});
    ASSERT_TRUE(packed.ok());
    EXPECT_EQ(packed.value().broken, std::vector<uint32_t>{14});
}

TEST(Pack, TooSmallABoundIsAnError) {
    EXPECT_FALSE(pack(some_shapes(), {.most_samples = 40, .effort = 1}).ok());
    EXPECT_FALSE(pack({}, {}).ok());
}

TEST(Pack, SameResultAtAnyThreadCount) {
    const auto one = pack(some_shapes(), {.most_samples = 4000, .effort = 3, .threads = 1});
    const auto many = pack(some_shapes(), {.most_samples = 4000, .effort = 3, .threads = 3});
    ASSERT_TRUE(one.ok() && many.ok());
    EXPECT_EQ(painted(one.value()), painted(many.value()));
}

}  // namespace
}  // namespace gim

#include "encoder/charts/squeeze.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace gim {
namespace {

constexpr uint32_t kCell = 2;

Shape rectangle_shape(double width, double height) {
    const std::vector<Vec2> border{{0, 0}, {width, 0}, {width, height}, {0, height}};
    Shape shape;
    for (int k = 0; k < 4; ++k)
        shape.push_back(make_piece(rasterize_chart(border, 1, k * std::numbers::pi / 2), kCell));
    return shape;
}

Shape star_shape(int points, double radius) {
    std::vector<Vec2> border;
    for (int i = 0; i < 2 * points; ++i) {
        const double angle = std::numbers::pi * i / points;
        border.push_back((i % 2 ? 0.6 : 1.0) * radius * Vec2(std::cos(angle), std::sin(angle)));
    }
    Shape shape;
    for (int k = 0; k < 8; ++k) shape.push_back(make_piece(rasterize_chart(border, 1, k * 0.785), kCell));
    return shape;
}

// Samples that two charts share, or neighbours of two charts in a row or column.
int conflicts(const std::vector<Shape>& shapes, const PieceLayout& layout) {
    std::vector<int> owner(size_t{layout.width} * layout.height, -1);
    int count = 0;
    for (size_t c = 0; c < shapes.size(); ++c) {
        const PieceSpot& spot = layout.spots[c];
        for (const PieceRun& run : shapes[c][spot.orientation].runs) {
            for (uint32_t k = 0; k < run.length; ++k) {
                const uint32_t column = spot.column + run.column + k, row = spot.row + run.row;
                EXPECT_LT(column, layout.width);
                EXPECT_LT(row, layout.height);
                int& sample = owner[size_t{row} * layout.width + column];
                count += sample >= 0;
                sample = static_cast<int>(c);
            }
        }
    }
    for (size_t i = 0; i < owner.size(); ++i) {
        const bool last = i % layout.width == layout.width - 1;
        if (!last && owner[i] >= 0 && owner[i + 1] >= 0 && owner[i] != owner[i + 1]) ++count;
        if (i + layout.width < owner.size() && owner[i] >= 0 && owner[i + layout.width] >= 0 &&
            owner[i] != owner[i + layout.width])
            ++count;
    }
    return count;
}

TEST(Separate, HeapOfChartsComesApart) {
    std::vector<Shape> shapes;
    for (int k = 0; k < 9; ++k) shapes.push_back(star_shape(3 + k % 4, 8 + k % 3));
    PieceLayout heap{70, 70, std::vector<PieceSpot>(shapes.size(), PieceSpot{0, 20, 20})};
    uint64_t moves = 0;
    const PieceLayout apart = separate(shapes, heap, {}, moves);
    ASSERT_EQ(apart.spots.size(), shapes.size());
    EXPECT_GT(moves, 0u);
    EXPECT_EQ(conflicts(shapes, apart), 0);
}

TEST(Separate, TooSmallARectangleGivesNothing) {
    const std::vector<Shape> shapes{rectangle_shape(10, 10), rectangle_shape(10, 10)};
    uint64_t moves = 0;
    EXPECT_TRUE(separate(shapes, {12, 12, {{0, 0, 0}, {0, 1, 1}}}, {.most_moves = 200}, moves).spots.empty());
}

TEST(Squeeze, BarsFillTheirRectangle) {
    // Side by side with gutters they leave a twelfth of the rectangle free.
    const std::vector<Shape> shapes(5, rectangle_shape(10, 40));
    PieceLayout loose{100, 70, {{0, 0, 20}, {0, 15, 25}, {0, 30, 20}, {0, 45, 10}, {0, 60, 25}}};
    uint64_t moves = 0;
    const PieceLayout tight = squeeze(shapes, loose, {.most_moves = 4000}, moves);
    EXPECT_EQ(conflicts(shapes, tight), 0);
    uint64_t defined = 0;
    for (size_t c = 0; c < shapes.size(); ++c) defined += shapes[c][tight.spots[c].orientation].chart.defined;
    EXPECT_GT(static_cast<double>(defined) / static_cast<double>(tight.area()), 0.9);
}

TEST(Squeeze, StopsAtTheAreaAskedFor) {
    const std::vector<Shape> shapes{rectangle_shape(10, 10), star_shape(5, 6)};
    uint64_t moves = 0;
    const PieceLayout layout = squeeze(shapes, {60, 60, {{0, 0, 0}, {0, 30, 30}}}, {.least_area = 2500}, moves);
    EXPECT_LE(layout.area(), 2500u);
    EXPECT_GT(layout.area(), 2400u);
}

}  // namespace
}  // namespace gim

#include "encoder/fit/prices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "encoder/fit/parts_basis.h"
#include "tests/encoder/fit/square_basis.h"
#include "tests/encoder/grid_images.h"

namespace gim {
namespace {

constexpr uint32_t kSide = 65;

// A torus in units. Rows crowd on its inner side, so cells differ in area by more than an order of magnitude.
SquareImage crowded_torus() {
    return image_of(kSide, {}, [](double u, double v) {
        const double turn = 2 * std::numbers::pi, a = turn * u, b = turn * v - 0.8 * std::sin(turn * v);
        const double from_axis = 700 - 300 * std::cos(b);
        return Vec3(from_axis * std::cos(a), from_axis * std::sin(a), 300 * std::sin(b));
    });
}

// A quarter of the area of the cells around each sample.
std::vector<double> areas_at(const SquareImage& image) {
    std::vector<double> areas(image.positions.size(), 0.0);
    for (uint32_t row = 0; row + 1 < kSide; ++row) {
        for (uint32_t column = 0; column + 1 < kSide; ++column) {
            const Vec3 main = image.at(row + 1, column + 1) - image.at(row, column),
                       anti = image.at(row + 1, column) - image.at(row, column + 1);
            for (const uint32_t v : {0u, 1u, kSide, kSide + 1})
                areas[row * kSide + column + v] += 0.125 * main.cross(anti).norm();
        }
    }
    return areas;
}

// Distances are sampled by area on both surfaces. So a move of samples costs twice the sum of squares, each weighted by
// the sample's area over the mean area. Without that scale the fit would take long where cells are large.
TEST(Prices, ScaleIsTheCurvatureOfTheDistances) {
    const SquareImage image = crowded_torus();
    const std::vector<double> areas = areas_at(image);
    double mean = 0;
    for (const double area : areas) mean += area / ((kSide - 1) * (kSide - 1));
    std::vector<float> units;
    for (const Vec3& p : image.positions) {
        for (int k = 0; k < 3; ++k) units.push_back(static_cast<float>(p[k]));
    }
    const test::SquareBasis square(units, kSide, {8, true, 3, static_cast<float>(mean)});
    const PartsBasis& basis = square.basis;
    // Details this large cost next to nothing.
    const Prices prices(basis, PartsBasis::Coordinates(basis.size(), 1e4f), 8, Free::kAll, 0.1f);
    const size_t diagonal = basis.size() - 3 * 32 * 32;  // the finest band, the last one
    double least = 1e9, most = 0;
    for (size_t row = 2; row < 30; ++row) {
        const size_t i = diagonal + 3 * (32 * row + 7 + row % 16);
        PartsBasis::Coordinates one(basis.size(), 0.0f);
        one[i] = 1;
        const std::vector<float> moves = basis.synthesize(one);
        double curvature = 0;
        for (size_t k = 0; k < moves.size(); ++k) curvature += 2 * areas[k / 3] / mean * moves[k] * moves[k];
        const double scale = 1 / double{prices.inverse[i]} - double{prices.price[i]};
        EXPECT_LT(std::abs(std::log2(scale / curvature)), 1) << "row " << row;
        least = std::min(least, curvature);
        most = std::max(most, curvature);
    }
    EXPECT_GT(most, 8 * least);
}

TEST(Prices, LargerDetailsAndFinerStepsCostLess) {
    std::vector<float> units;
    for (const Vec3& p : crowded_torus().positions) {
        for (int k = 0; k < 3; ++k) units.push_back(static_cast<float>(p[k]));
    }
    const test::SquareBasis square(units, kSide, {8, true, 3, 0});
    const PartsBasis& basis = square.basis;
    const PartsBasis::Coordinates small(basis.size(), 1.0f), large(basis.size(), 50.0f);
    const Prices cheap(basis, large, 8, Free::kAll, 0.1f), dear(basis, small, 8, Free::kAll, 0.1f),
        fine(basis, large, 4, Free::kAll, 0.1f), held(basis, large, 8, Free::kNormals, 0.1f);
    for (size_t i = 0; i < basis.size(); ++i) {
        if (i < basis.base_size()) {
            ASSERT_EQ(cheap.price[i], 0) << "the base is not paid for";
            continue;
        }
        ASSERT_GT(cheap.price[i], 0);
        ASSERT_LT(cheap.price[i], dear.price[i]);
        ASSERT_LT(fine.price[i], cheap.price[i]);
        if (basis.is_tangential(i)) {
            ASSERT_EQ(held.inverse[i], 0);
        } else {
            ASSERT_EQ(held.inverse[i], cheap.inverse[i]);
        }
    }
}

}  // namespace
}  // namespace gim

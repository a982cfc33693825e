#include "encoder/code/detail_response.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "encoder/base/parallel.h"
#include "encoder/code/wavelet_analysis.h"
#include "format/seam.h"

namespace gim {
namespace {

constexpr float kLeftOut = 0.02f;  // of the largest weight, at most

struct Size {
    uint32_t columns, rows, steps;
    bool has_rim;
};

// The bands of an image of that size, all zero.
Pyramid<float> zero_bands(const Size& size) {
    return analyse<Irreversible97>(std::vector<float>(size_t{3} * size.columns * size.rows), size.columns, size.rows,
                                   size.steps);
}

struct BandSize {
    uint32_t columns, rows;
};
BandSize band_size(const Pyramid<float>& bands, uint32_t depth, Orientation orientation) {
    const uint32_t columns = bands.columns_at(bands.steps() - depth + 1),
                   rows = bands.rows_at(bands.steps() - depth + 1);
    return {orientation == Orientation::kVertical ? low_count(columns) : high_count(columns),
            orientation == Orientation::kHorizontal ? low_count(rows) : high_count(rows)};
}

std::vector<float>& band_of(Pyramid<float>& bands, uint32_t depth, Orientation orientation) {
    AnalysisLevel<float>& level = bands.levels[bands.steps() - depth];
    return orientation == Orientation::kHorizontal ? level.horizontal
           : orientation == Orientation::kVertical ? level.vertical
                                                   : level.diagonal;
}

// The image that a detail of 1 in the first component makes.
std::vector<float> image_of_detail(const Size& size, uint32_t depth, Orientation orientation, uint32_t row,
                                   uint32_t column) {
    Pyramid<float> bands = zero_bands(size);
    band_of(bands, depth, orientation)[3 * (size_t{row} * band_size(bands, depth, orientation).columns + column)] = 1;
    const SeamTable open{};
    const std::vector<float> image = restore<Irreversible97>(bands, size.has_rim ? &open : nullptr);
    std::vector<float> first;
    for (size_t i = 0; i < image.size(); i += 3) first.push_back(image[i]);
    return first;
}

std::vector<float> spread(const ResponseBlock& block, const Size& size) {
    std::vector<float> image(size_t{size.columns} * size.rows);
    for (uint32_t r = 0; r < block.rows; ++r) {
        for (uint32_t c = 0; c < block.columns; ++c)
            image.at(size_t{block.row + r} * size.columns + block.column + c) = block.weights[r * block.columns + c];
    }
    return image;
}

// Places near the ends, where functions are of their own, and in the middle.
std::vector<uint32_t> places(uint32_t count) {
    std::vector<uint32_t> result;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t to_end = std::min(i, count - 1 - i);
        if (to_end < 3 || to_end == 4 || to_end == 5 || i == count / 2) result.push_back(i);
    }
    return result;
}

void expect_responses(const Size& size, const std::vector<uint32_t>& depths) {
    DetailResponses responses(size.columns, size.rows, size.has_rim);
    const Pyramid<float> bands = zero_bands(size);
    for (const uint32_t depth : depths) {
        for (const auto orientation : {Orientation::kHorizontal, Orientation::kVertical, Orientation::kDiagonal}) {
            const BandSize band = band_size(bands, depth, orientation);
            for (const uint32_t row : places(band.rows)) {
                for (const uint32_t column : places(band.columns)) {
                    const ResponseBlock block = responses.at(depth, orientation, row, column);
                    ASSERT_LE(block.row + block.rows, size.rows);
                    ASSERT_LE(block.column + block.columns, size.columns);
                    const std::vector<float> known = spread(block, size),
                                             exact = image_of_detail(size, depth, orientation, row, column);
                    float most = 0, inside = 0, outside = 0;
                    for (size_t i = 0; i < exact.size(); ++i) {
                        most = std::max(most, std::abs(exact[i]));
                        float& off = known[i] != 0 ? inside : outside;
                        off = std::max(off, std::abs(exact[i] - known[i]));
                    }
                    ASSERT_LT(inside, 1e-4f * most)
                        << "depth " << depth << " band " << int(orientation) << " at " << row << ", " << column;
                    ASSERT_LT(outside, (kLeftOut + 1e-4f) * most)
                        << "depth " << depth << " band " << int(orientation) << " at " << row << ", " << column;
                }
            }
        }
    }
}

TEST(DetailResponses, AreWhatRestoreMakesOfADetailInASquareWithARim) {
    expect_responses({129, 129, 7, true}, {1, 2, 3});
}

TEST(DetailResponses, AreWhatRestoreMakesOfADetailInARectangleOfOddSides) {
    expect_responses({75, 46, 4, false}, {1, 2, 3});
    expect_responses({46, 75, 4, false}, {2});
}

TEST(DetailResponses, ImagesThatAreSmallerThanAFunctionHaveTheirOwn) {
    expect_responses({33, 33, 5, true}, {1, 2, 3});
    expect_responses({9, 14, 2, false}, {1, 2});
}

TEST(DetailResponses, SeveralThreadsMayAskAtOnce) {
    constexpr size_t kCount = 3 * 65 * 64;
    DetailResponses one_by_one(129, 129, true), at_once(129, 129, true);
    const auto ask = [](DetailResponses& responses, size_t i) {
        const auto orientation = static_cast<Orientation>(i % 3);
        const auto row = static_cast<uint32_t>(i / 3 / 64), column = static_cast<uint32_t>(i / 3 % 64);
        const ResponseBlock block = responses.at(1, orientation, std::min(row, 63u), column);
        return std::vector<float>(block.weights, block.weights + size_t{block.rows} * block.columns);
    };
    std::vector<std::vector<float>> found(kCount);
    with_threads(4, [&] {
        parallel_blocks(kCount, 16, 0, [&](size_t, size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) found[i] = ask(at_once, i);
        });
    });
    for (size_t i = 0; i < kCount; ++i) ASSERT_EQ(found[i], ask(one_by_one, i)) << i;
}

TEST(DetailResponses, WeightsStayWhereTheyAre) {
    DetailResponses responses(129, 129, true);
    const ResponseBlock first = responses.at(1, Orientation::kHorizontal, 20, 20);
    for (uint32_t row = 0; row < 64; ++row) (void)responses.at(2, Orientation::kVertical, row / 2, row / 2);
    const ResponseBlock again = responses.at(1, Orientation::kHorizontal, 20, 20),
                        shifted = responses.at(1, Orientation::kHorizontal, 21, 25);
    EXPECT_EQ(first.weights, again.weights);
    EXPECT_EQ(first.weights, shifted.weights);
    EXPECT_EQ(first.row + 2, shifted.row);
    EXPECT_EQ(first.column + 10, shifted.column);
}

}  // namespace
}  // namespace gim

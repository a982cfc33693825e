#include "format/detail_frame.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <vector>

#include "tests/format/random_sideband.h"

namespace gim {
namespace {

using test::Random;

constexpr uint32_t kSide = 17;
constexpr Orientation kOrientations[] = {Orientation::kHorizontal, Orientation::kVertical, Orientation::kDiagonal};

struct Place {
    Orientation orientation;
    uint32_t row, column;
};

// All details of the three bands that belong to a small image.
std::vector<Place> places(uint32_t columns, uint32_t rows) {
    std::vector<Place> all;
    for (const Orientation orientation : kOrientations) {
        for (uint32_t row = 0; row < rows - (orientation == Orientation::kHorizontal ? 0 : 1); ++row) {
            for (uint32_t column = 0; column < columns - (orientation == Orientation::kVertical ? 0 : 1); ++column)
                all.push_back({orientation, row, column});
        }
    }
    return all;
}

// A bent sheet whose cells are about 3 units wide and 2 high.
std::vector<float> sheet(uint32_t side) {
    std::vector<float> image;
    for (uint32_t row = 0; row < side; ++row) {
        for (uint32_t column = 0; column < side; ++column) {
            const auto x = static_cast<float>(column), y = static_cast<float>(row);
            image.insert(image.end(), {3 * x + 0.2f * y, 2 * y + 0.02f * x * x, std::sin(0.7f * x) + 0.1f * x * y});
        }
    }
    return image;
}

float dot(const float* a, const float* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void expect_right_handed(const DetailFrame& frame) {
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(dot(frame.axis[i], frame.axis[j]), i == j ? 1 : 0, 2e-6f) << i << " " << j;
    }
    const auto& [n, t, b] = frame.axis;
    const float determinant =
        n[0] * (t[1] * b[2] - t[2] * b[1]) - n[1] * (t[0] * b[2] - t[2] * b[0]) + n[2] * (t[0] * b[1] - t[1] * b[0]);
    EXPECT_NEAR(determinant, 1, 4e-6f);
}

void expect_fallback(const DetailFrame& frame) {
    const float axes[3][3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) EXPECT_EQ(frame.axis[i][k], axes[i][k]);
    }
    EXPECT_EQ(frame.scale, 1.0f);
}

TEST(DetailFrame, AxesAreOrthonormalAndRightHanded) {
    const std::vector<float> image = sheet(kSide);
    const FrameField field(image.data(), kSide, kSide, 6);
    for (const Place& p : places(kSide, kSide)) {
        SCOPED_TRACE(testing::Message() << int(p.orientation) << " " << p.row << " " << p.column);
        expect_right_handed(field.at(p.orientation, p.row, p.column));
    }
}

TEST(DetailFrame, FirstAxisIsTheNormalAndSecondRunsAlongTheRow) {
    // In the plane z = 0, rows downwards (y) and columns to the right (x): the normal is x cross y.
    std::vector<float> image;
    for (uint32_t row = 0; row < kSide; ++row) {
        for (uint32_t column = 0; column < kSide; ++column)
            image.insert(image.end(), {5.0f * float(column), 4.0f * float(row) + 3.0f * float(column), 0});
    }
    const FrameField field(image.data(), kSide, kSide, 0);
    for (const Place& p : places(kSide, kSide)) {
        const DetailFrame frame = field.at(p.orientation, p.row, p.column);
        EXPECT_EQ(frame.axis[0][2], 1.0f);
        EXPECT_NEAR(frame.axis[1][0], 5 / std::sqrt(34.0f), 1e-6f);
        EXPECT_NEAR(frame.axis[1][1], 3 / std::sqrt(34.0f), 1e-6f);
        EXPECT_EQ(frame.scale, 1.0f);
    }
}

// Each detail lies between samples of the small image; those around it give its tangents. A peak shows which ones.
TEST(DetailFrame, OnlySamplesAroundTheDetailCount) {
    const std::vector<float> flat = sheet(kSide);
    for (const Place& p : places(kSide, kSide)) {
        const DetailFrame before = FrameField(flat.data(), kSide, kSide, 6).at(p.orientation, p.row, p.column);
        for (uint32_t row = 0; row < kSide; ++row) {
            for (uint32_t column = 0; column < kSide; ++column) {
                const int64_t r = int64_t{row} - p.row, c = int64_t{column} - p.column;
                bool counts = r >= 0 && r <= 1 && c >= 0 && c <= 1;
                if (p.orientation == Orientation::kHorizontal) counts = r >= -1 && r <= 1 && c >= 0 && c <= 1;
                if (p.orientation == Orientation::kVertical) counts = r >= 0 && r <= 1 && c >= -1 && c <= 1;
                if (counts) continue;
                std::vector<float> peak = flat;
                for (size_t k = 0; k < 3; ++k) peak[3 * (row * kSide + column) + k] += 7;
                const DetailFrame after = FrameField(peak.data(), kSide, kSide, 6).at(p.orientation, p.row, p.column);
                for (int i = 0; i < 3; ++i) {
                    for (int k = 0; k < 3; ++k) ASSERT_EQ(after.axis[i][k], before.axis[i][k]);
                }
                ASSERT_EQ(after.scale, before.scale);
            }
        }
    }
}

// Computed with written-out numbers, as in spec/gim-format.md.
TEST(DetailFrame, TangentsAreThoseOfTheText) {
    Random random(5);
    std::vector<float> image(3 * size_t{5} * 4);
    for (float& x : image) x = 16 * random.unit();
    const uint32_t columns = 5;
    const auto at = [&](uint32_t row, uint32_t column, int k) {
        return image[3 * (row * columns + column) + size_t(k)];
    };
    const FrameField field(image.data(), columns, 4, 0);
    const auto expect_tangents = [&](const DetailFrame& frame, const std::array<float, 3>& u,
                                     const std::array<float, 3>& v) {
        const float along = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
        const float m[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        const float area = std::sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
        for (size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(frame.axis[0][k], m[k] / area);
            EXPECT_EQ(frame.axis[1][k], u[k] / along);
        }
    };
    std::array<float, 3> u{}, v{};
    for (int k = 0; k < 3; ++k) {  // inside
        u[size_t(k)] = at(2, 2, k) - at(2, 1, k);
        v[size_t(k)] = 0.25f * ((at(3, 1, k) - at(1, 1, k)) + (at(3, 2, k) - at(1, 2, k)));
    }
    expect_tangents(field.at(Orientation::kHorizontal, 2, 1), u, v);
    for (int k = 0; k < 3; ++k) {  // in the last row
        u[size_t(k)] = at(3, 4, k) - at(3, 3, k);
        v[size_t(k)] = 0.5f * ((at(3, 3, k) - at(2, 3, k)) + (at(3, 4, k) - at(2, 4, k)));
    }
    expect_tangents(field.at(Orientation::kHorizontal, 3, 3), u, v);
    for (int k = 0; k < 3; ++k) {  // in the first column
        u[size_t(k)] = 0.5f * ((at(1, 1, k) - at(1, 0, k)) + (at(2, 1, k) - at(2, 0, k)));
        v[size_t(k)] = at(2, 0, k) - at(1, 0, k);
    }
    expect_tangents(field.at(Orientation::kVertical, 1, 0), u, v);
    for (int k = 0; k < 3; ++k) {
        u[size_t(k)] = 0.5f * ((at(0, 3, k) - at(0, 2, k)) + (at(1, 3, k) - at(1, 2, k)));
        v[size_t(k)] = 0.5f * ((at(1, 2, k) - at(0, 2, k)) + (at(1, 3, k) - at(0, 3, k)));
    }
    expect_tangents(field.at(Orientation::kDiagonal, 0, 2), u, v);
}

TEST(DetailFrame, DegenerateImagesHaveTheFallbackFrame) {
    std::vector<float> point(3 * kSide * kSide, 77.0f), line = point;
    for (size_t i = 0; i < line.size(); i += 3) line[i] = static_cast<float>(i);
    for (const auto* image : {&point, &line}) {
        const FrameField field(image->data(), kSide, kSide, 6);
        for (const Place& p : places(kSide, kSide)) expect_fallback(field.at(p.orientation, p.row, p.column));
    }
}

// Charts of even width have a last detail with no sample of the small image behind it.
TEST(DetailFrame, BeyondTheLastSampleIsTheFallbackFrame) {
    const std::vector<float> image = sheet(kSide);
    const FrameField field(image.data(), kSide, kSide, 6);
    expect_fallback(field.at(Orientation::kHorizontal, 3, kSide - 1));
    expect_fallback(field.at(Orientation::kVertical, kSide - 1, 3));
    expect_fallback(field.at(Orientation::kDiagonal, kSide - 1, kSide - 1));
}

// A flat grid of cells with that area.
std::vector<float> cells_of(float area, uint32_t side) {
    std::vector<float> image;
    for (uint32_t row = 0; row < side; ++row) {
        for (uint32_t column = 0; column < side; ++column)
            image.insert(image.end(), {0, area * static_cast<float>(column), static_cast<float>(row)});
    }
    return image;
}

TEST(DetailFrame, StepsFallWithTheFourthRootOfTheArea) {
    for (const auto& [area, scale] :
         std::initializer_list<std::pair<float, float>>{{1, 2}, {16, 1}, {256, 0.5f}, {4096, 0.25f}, {65536, 0.125f}}) {
        const std::vector<float> image = cells_of(area, kSide);
        const FrameField field(image.data(), kSide, kSide, 16);
        for (const Place& p : places(kSide, kSide))
            EXPECT_EQ(field.at(p.orientation, p.row, p.column).scale, scale) << area;
    }
}

TEST(DetailFrame, ScalesStayBetweenAnEighthAndEight) {
    for (const auto& [area, scale] : {std::pair{1e-3f, 8.0f}, std::pair{1e9f, 0.125f}}) {
        const std::vector<float> image = cells_of(area, kSide);
        EXPECT_EQ(FrameField(image.data(), kSide, kSide, 1000).at(Orientation::kDiagonal, 3, 3).scale, scale);
    }
}

TEST(DetailFrame, SmallImagesAndFilesWithoutAreaHaveNoScale) {
    const std::vector<float> image = cells_of(1, kSide);
    EXPECT_EQ(FrameField(image.data(), kSide, kSide, 0).at(Orientation::kVertical, 3, 3).scale, 1.0f);
    EXPECT_EQ(FrameField(image.data(), 8, kSide, 16).at(Orientation::kVertical, 3, 3).scale, 1.0f);
    EXPECT_EQ(FrameField(image.data(), kSide, 8, 16).at(Orientation::kVertical, 3, 3).scale, 1.0f);
    EXPECT_EQ(FrameField(cells_of(1, 9).data(), 9, 9, 16).at(Orientation::kVertical, 3, 3).scale, 2.0f);
}

TEST(DetailFrame, CellsGrowByFourPerLevel) {
    const DetailCoding coding{8, true, 3, 10};
    EXPECT_EQ(coding.steps_at(1).cell_area, 40.0f);
    EXPECT_EQ(coding.steps_at(14).cell_area, 10 * 0x1p28f);
    EXPECT_EQ(coding.steps_at(2).edge, band_step(8, 2, Orientation::kVertical));
    EXPECT_EQ(coding.steps_at(2).diagonal, band_step(8, 2, Orientation::kDiagonal));
}

TEST(DetailFrame, HeadersWithoutTangentialStepsMeanNoFrames) {
    Header header;
    header.quantizer = 4;
    EXPECT_FALSE(detail_coding_of(header).in_frames);
    header.tangential = 20;
    header.cell_area = 80;
    EXPECT_TRUE(detail_coding_of(header).in_frames);
    EXPECT_EQ(detail_coding_of(header).tangential, 2.5f);
    EXPECT_EQ(detail_coding_of(header).cell_area, 4.0f);
}

TEST(DetailFrame, WhatGoesIntoAFrameComesOutAgain) {
    const std::vector<float> image = sheet(kSide);
    const FrameField field(image.data(), kSide, kSide, 6);
    const float detail[3] = {3, -5, 7};
    for (const Place& p : places(kSide, kSide)) {
        const DetailFrame frame = field.at(p.orientation, p.row, p.column);
        float local[3], back[3];
        into_frame(frame, detail, local);
        out_of_frame(frame, local, back);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(back[k], detail[k], 2e-5f);
    }
}

TEST(DetailFrame, OnlyNormalStepsFollowTheArea) {
    const DetailFrame frame = {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, 2};
    const DetailSteps steps{5, 3, true, 1.5f, 0};
    float step[3];
    steps_in(frame, steps, Orientation::kHorizontal, step);
    EXPECT_EQ(step[0], 10.0f);
    EXPECT_EQ(step[1], 7.5f);
    EXPECT_EQ(step[2], 7.5f);
    steps_in(frame, steps, Orientation::kDiagonal, step);
    EXPECT_EQ(step[0], 6.0f);
}

TEST(DetailFrame, HostileImagesHaveFiniteFrames) {
    constexpr float kInf = std::numeric_limits<float>::infinity(), kMax = std::numeric_limits<float>::max();
    const float hostile[] = {kInf, -kInf, kMax, -kMax, std::nanf(""), 0x1p-149f, 0x1p64f, -0x1p50f, 0x1p-30f, 0, 1};
    Random random(9);
    for (int round = 0; round < 50; ++round) {
        std::vector<float> image = sheet(kSide);
        for (float& x : image) {
            if (random.below(round < 25 ? 4 : 40) == 0) x = hostile[random.below(std::size(hostile))];
        }
        const FrameField field(image.data(), kSide, kSide, round % 2 ? 1e-6f : 0x1p70f);
        for (const Place& p : places(kSide, kSide)) {
            const DetailFrame frame = field.at(p.orientation, p.row, p.column);
            for (const auto& axis : frame.axis) {
                for (const float x : axis) ASSERT_LE(std::abs(x), 1.001f);  // false for a NaN
            }
            ASSERT_GE(frame.scale, 0.125f);
            ASSERT_LE(frame.scale, 8.0f);
        }
    }
}

// A decoder makes many frames at once. Some are hostile.
TEST(DetailFrame, AreTheSameOneByOneAndTogether) {
    std::vector<float> image = sheet(kSide);
    for (size_t i = 0; i < 3 * 40; ++i) image[i + 300] = i < 60 ? 0.0f : std::nanf("");
    const FrameField field(image.data(), kSide, kSide, 6);
    for (const Orientation orientation : kOrientations) {
        std::vector<uint32_t> columns;
        for (uint32_t column = orientation == Orientation::kVertical ? 0 : 1; column < kSide; ++column)
            columns.push_back(kSide - 1 - column);
        for (uint32_t row = 0; row + 1 < kSide; ++row) {
            DetailLanes<24> lanes;
            field.find_tangents(orientation, row, columns.data(), columns.size(), lanes, 3);
            field.make_frames(lanes, 20);
            for (size_t i = 0; i < columns.size(); ++i) {
                const DetailFrame frame = field.at(orientation, row, columns[i]);
                for (size_t a = 0; a < 3; ++a)
                    for (size_t k = 0; k < 3; ++k) ASSERT_EQ(lanes.axis[a][k][3 + i], frame.axis[a][k]);
                ASSERT_EQ(lanes.scale[3 + i], frame.scale);
            }
        }
    }
}

}  // namespace
}  // namespace gim

#include "encoder/fit/parts_basis.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/encoder/fit/square_basis.h"
#include "tests/encoder/grid_images.h"
#include "tests/format/random_sideband.h"

namespace gim {
namespace {

using test::Random;

constexpr uint32_t kSide = 65;
constexpr DetailCoding kCoding{8, true, 3, 900};

// A torus, in units.
std::vector<float> torus_units() {
    std::vector<float> units;
    for (const Vec3& p : torus_image(kSide, 700, 300).positions) {
        for (int k = 0; k < 3; ++k) units.push_back(static_cast<float>(p[k]));
    }
    return units;
}

std::vector<float> noise(size_t count, uint64_t seed) {
    Random random(seed);
    std::vector<float> values(count);
    for (float& v : values) v = 2 * random.unit() - 1;
    return values;
}

// The gluing of the torus: opposite sides are one.
SeamTable torus_seams() {
    SeamTable seams;
    EXPECT_EQ(build_seam_table(torus_image(kSide, 700, 300).sideband, &seams), Status::kOk);
    return seams;
}

double dot(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += double{a[i]} * double{b[i]};
    return sum;
}

TEST(PartsBasis, ImagesComeBackFromTheirCoordinates) {
    const std::vector<float> image = torus_units();
    const test::SquareBasis square(image, kSide, kCoding);
    const PartsBasis& basis = square.basis;
    ASSERT_EQ(basis.size(), image.size());
    for (const auto& x : {image, noise(image.size(), 1)}) {
        const PartsBasis::Coordinates c = basis.analyse(x);
        ASSERT_EQ(c.size(), basis.size());
        const std::vector<float> back = basis.synthesize(c);
        for (size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(back[i], x[i], 4e-3f);
    }
}

TEST(PartsBasis, TransposedIsTheAdjointOfSynthesis) {
    const std::vector<float> image = torus_units();
    const test::SquareBasis square(image, kSide, kCoding);
    const PartsBasis& basis = square.basis;
    for (uint64_t seed = 1; seed < 6; ++seed) {
        const std::vector<float> c = noise(basis.size(), seed), x = noise(image.size(), seed + 100);
        const std::vector<float> synthesized = basis.synthesize(c);
        const double length = std::sqrt(dot(synthesized, synthesized) * dot(x, x));
        EXPECT_NEAR(dot(synthesized, x), dot(c, basis.transposed(x)), 1e-6 * length);
    }
}

TEST(PartsBasis, GluedImagesComeBackFromWhatMatesShare) {
    const std::vector<float> image = torus_units();
    const SeamTable seams = torus_seams();
    const test::SquareBasis square(image, kSide, kCoding, &seams);
    const PartsBasis& basis = square.basis;
    const PartsBasis::Coordinates c = basis.analyse(image);
    size_t copies = 0;
    for (size_t i = 0; i < c.size(); ++i) {
        copies += basis.is_copy(i);
        if (basis.is_copy(i)) {
            ASSERT_EQ(c[i], 0);
        }
    }
    EXPECT_EQ(copies, 3u * 2 * (kSide - 2));  // a detail for each sample between the cut-nodes of two of the sides
    const std::vector<float> back = basis.synthesize(c);
    for (size_t i = 0; i < image.size(); ++i) ASSERT_NEAR(back[i], image[i], 4e-3f);
}

TEST(PartsBasis, TransposedIsTheAdjointOfSynthesisWithSharedRims) {
    const std::vector<float> image = torus_units();
    const SeamTable seams = torus_seams();
    const test::SquareBasis square(image, kSide, kCoding, &seams);
    const PartsBasis& basis = square.basis;
    for (uint64_t seed = 1; seed < 6; ++seed) {
        std::vector<float> c = noise(basis.size(), seed);
        for (size_t i = 0; i < c.size(); ++i) c[i] *= !basis.is_copy(i);
        const std::vector<float> x = noise(image.size(), seed + 100), synthesized = basis.synthesize(c);
        const double length = std::sqrt(dot(synthesized, synthesized) * dot(x, x));
        EXPECT_NEAR(dot(synthesized, x), dot(c, basis.transposed(x)), 1e-6 * length);
    }
}

TEST(PartsBasis, NormsAreThoseOfTheSynthesisFunctions) {
    const std::vector<float> image = torus_units();
    const test::SquareBasis square(image, kSide, kCoding);
    const PartsBasis& basis = square.basis;
    // The finest bands come last: horizontal 33 x 32, vertical 32 x 33, diagonal 32 x 32.
    const size_t diagonal = basis.size() - 3 * 32 * 32, vertical = diagonal - 3 * 32 * 33,
                 horizontal = vertical - 3 * 33 * 32;
    for (const auto& [first, columns] :
         {std::pair{horizontal, 32u}, std::pair{vertical, 33u}, std::pair{diagonal, 32u}}) {
        for (size_t k = 0; k < 3; ++k) {
            const size_t i = first + 3 * (16 * columns + 15) + k;
            std::vector<float> c(basis.size());
            c[i] = 1;
            const std::vector<float> function = basis.synthesize(c);
            EXPECT_NEAR(std::sqrt(dot(function, function)), basis.norm(i), 1e-3);
        }
    }
}

TEST(PartsBasis, StepsFollowBandComponentAndArea) {
    const std::vector<float> image = torus_units();
    const test::SquareBasis square(image, kSide, kCoding), flat(image, kSide, {8, true, 3, 0});
    const PartsBasis &basis = square.basis, &without_area = flat.basis;
    for (size_t i = 0; i < basis.size(); ++i) {
        const bool tangential = i >= basis.base_size() && i % 3 != 0;
        ASSERT_EQ(basis.is_tangential(i), tangential);
        ASSERT_FLOAT_EQ(without_area.step(i) * without_area.norm(i), tangential ? 24 : 8);
        ASSERT_EQ(without_area.relative_area(i), 1.0f);
        // Normal steps are divided by the fourth root of the ratio of areas.
        const float scale = basis.step(i) / without_area.step(i);
        if (tangential) {
            ASSERT_EQ(scale, 1.0f);
            continue;
        }
        ASSERT_NEAR(std::pow(scale, 4.0f) * basis.relative_area(i), 1, 1e-4f);
    }
    // Outer cells of the torus are larger than inner ones. Their mean is about that of the coding.
    float least = 1, most = 1;
    for (size_t i = 0; i < basis.size(); ++i) {
        least = std::min(least, basis.relative_area(i));
        most = std::max(most, basis.relative_area(i));
    }
    EXPECT_LT(least, 0.8f);
    EXPECT_GT(most, 1.2f);
}

// Two boxes of odd and even sizes, with undefined samples, in an image that is larger.
std::vector<CodedPart> two_boxes() {
    std::vector<CodedPart> parts{{14, 9, 2, 1, nullptr, {}}, {7, 20, 20, -1, nullptr, {}}};
    for (CodedPart& part : parts) {
        for (size_t i = 0; i < part.sample_count(); ++i) {
            const uint32_t row = static_cast<uint32_t>(i / part.columns),
                           column = static_cast<uint32_t>(i % part.columns);
            const bool is_rim = row == 0 || column == 0 || row + 1 == part.rows || column + 1 == part.columns;
            part.defined.push_back(!is_rim && row + column > 3);
        }
    }
    return parts;
}
constexpr uint32_t kWidth = 30, kHeight = 24;

TEST(PartsBasis, DefinedSamplesOfBoxesComeBack) {
    const std::vector<CodedPart> parts = two_boxes();
    std::vector<std::vector<float>> boxes;
    for (const CodedPart& part : parts) boxes.push_back(noise(3 * part.sample_count(), part.columns));
    const PartsBasis basis(parts, boxes, kWidth, kWidth * kHeight, kCoding);
    const std::vector<float> image = noise(size_t{3} * kWidth * kHeight, 3);
    const PartsBasis::Coordinates c = basis.analyse(image);
    const std::vector<float> back = basis.synthesize(c);
    const std::vector<std::vector<float>> all = basis.boxes_of(c);
    std::vector<bool> is_defined(kWidth * kHeight);
    for (size_t p = 0; p < parts.size(); ++p) {
        std::vector<bool> in_box(parts[p].sample_count());
        parts[p].for_each_defined(kWidth, [&](size_t in_part, size_t in_image) {
            is_defined[in_image] = in_box[in_part] = true;
            for (size_t k = 0; k < 3; ++k) {
                EXPECT_NEAR(back[3 * in_image + k], image[3 * in_image + k], 1e-5f);
                EXPECT_NEAR(all[p][3 * in_part + k], image[3 * in_image + k], 1e-5f);
            }
        });
        for (size_t i = 0; i < in_box.size(); ++i) {
            if (in_box[i]) continue;
            EXPECT_NEAR(all[p][3 * i], boxes[p][3 * i], 1e-5f) << "as the box had it";
        }
    }
    for (size_t i = 0; i < is_defined.size(); ++i) {
        if (is_defined[i]) continue;
        EXPECT_EQ(back[3 * i], 0);
    }
}

TEST(PartsBasis, TransposedIsTheAdjointOfSynthesisOfBoxes) {
    const std::vector<CodedPart> parts = two_boxes();
    std::vector<std::vector<float>> boxes;
    for (const CodedPart& part : parts) boxes.push_back(noise(3 * part.sample_count(), part.rows));
    const PartsBasis basis(parts, boxes, kWidth, kWidth * kHeight, kCoding);
    for (uint64_t seed = 1; seed < 6; ++seed) {
        const std::vector<float> c = noise(basis.size(), seed), x = noise(size_t{3} * kWidth * kHeight, seed + 100);
        const std::vector<float> synthesized = basis.synthesize(c);
        const double length = std::sqrt(dot(synthesized, synthesized) * dot(x, x));
        EXPECT_NEAR(dot(synthesized, x), dot(c, basis.transposed(x)), 1e-6 * length);
    }
}

// If all samples of a flat image move along its normal, only normal coordinates change.
TEST(PartsBasis, FirstComponentIsAlongTheNormal) {
    std::vector<float> plane;
    for (uint32_t row = 0; row < kSide; ++row) {
        for (uint32_t column = 0; column < kSide; ++column)
            plane.insert(plane.end(), {0, 10.0f * float(column), 10.0f * float(row)});
    }
    const test::SquareBasis square(plane, kSide, kCoding);
    const PartsBasis& basis = square.basis;
    std::vector<float> moved = plane;
    Random random(7);
    for (size_t i = 0; i < moved.size(); i += 3) moved[i] += random.unit();
    const PartsBasis::Coordinates before = basis.analyse(plane), after = basis.analyse(moved);
    double normal = 0;
    for (size_t i = basis.base_size(); i < after.size(); ++i) {
        if (basis.is_tangential(i)) {
            ASSERT_NEAR(after[i], before[i], 1e-3f);
        } else {
            normal += std::abs(double{after[i]} - before[i]);
        }
    }
    EXPECT_GT(normal, 100);
}

}  // namespace
}  // namespace gim

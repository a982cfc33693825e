#include "format/fuse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "format/close_seams.h"
#include "format/seam.h"
#include "tests/format/random_sideband.h"

namespace gim {
namespace {

struct Fixture {
    uint32_t side, count;
    std::vector<uint32_t> class_of, first, members;
    std::vector<float> sums, outer, inner, x;

    Fixture(uint32_t n, const Sideband& sideband, uint64_t seed) : side(n), class_of(ring_length(n)) {
        SeamTable table;
        EXPECT_EQ(build_seam_table(sideband, &table), Status::kOk);
        ring_classes(table, side, class_of);
        count = ring_class_count(table, side);
        first.resize(count);
        members.resize(count);
        sums.resize(count * 3);
        outer.resize(class_of.size() * 3);
        inner.resize(class_of.size() * 3);
        test::Random random(seed);
        for (uint32_t i = 0; i < side * side * 3; ++i) x.push_back(random.unit());
    }
    float* at(uint32_t k) {
        const GridPoint p = ring_point(side, k);
        return &x[(size_t{p.row} * side + p.column) * 3];
    }
    void run() {
        fuse(side, class_of.data(), count, x.data(),
             {sums.data(), first.data(), members.data(), outer.data(), inner.data()});
    }
};

const Sideband kTorus = {5, 0, {{2, 4}, {3, 4}, {0, 4}, {1, 4}}};

TEST(Fuse, ClassesMeetAtTheirMean) {
    Fixture f(17, kTorus, 1);
    std::vector<double> mean(f.count * 3), members(f.count);
    for (uint32_t k = 0; k < f.class_of.size(); ++k) {
        ++members[f.class_of[k]];
        for (uint32_t i = 0; i < 3; ++i) mean[f.class_of[k] * 3 + i] += double{f.at(k)[i]};
    }
    f.run();
    for (uint32_t k = 0; k < f.class_of.size(); ++k)
        for (uint32_t i = 0; i < 3; ++i) {
            EXPECT_NEAR(f.at(k)[i], mean[f.class_of[k] * 3 + i] / members[f.class_of[k]], 1e-6);
        }
    for (uint32_t k = 0; k < f.class_of.size(); ++k) {
        for (uint32_t l = 0; l < k; ++l) {
            if (f.class_of[k] != f.class_of[l]) continue;
            for (uint32_t i = 0; i < 3; ++i) ASSERT_EQ(f.at(k)[i], f.at(l)[i]);
        }
    }
}

TEST(Fuse, NothingMovesWhereAllAgree) {
    Fixture f(17, kTorus, 2);
    std::vector<uint32_t> seen(f.count, UINT32_MAX);
    for (uint32_t k = 0; k < f.class_of.size(); ++k) {
        if (seen[f.class_of[k]] == UINT32_MAX) seen[f.class_of[k]] = k;
        for (uint32_t i = 0; i < 3; ++i) f.at(k)[i] = f.at(seen[f.class_of[k]])[i];
    }
    const auto before = f.x;
    f.run();
    EXPECT_EQ(f.x, before);
}

TEST(Fuse, CorrectionsFadeTowardsTheInsideAndStop) {
    // Only the two sides of the cut differ, by a step of one.
    const Sideband fold = {65, 16, {{1, 128}, {0, 128}}};
    Fixture f(65, fold, 3);
    std::fill(f.x.begin(), f.x.end(), 0.0f);
    for (uint32_t k = 16; k < 16 + 128; ++k) f.at(k)[0] = 1.0f;
    f.at(16)[0] = f.at(144)[0] = 0.5f;  // the leaves
    f.run();
    const uint32_t width = diffusion_width(65);
    EXPECT_EQ(width, 4u);
    // Inwards from the middle of the last column the correction starts at one half and fades.
    float last = 0.5f;
    for (uint32_t depth = 0; depth <= width; ++depth) {
        const float v = f.x[(32 * 65 + 64 - depth) * 3];
        const float correction = depth == 0 ? v : std::abs(v);
        EXPECT_LE(correction, last + 1e-6f) << depth;
        last = correction;
    }
    EXPECT_GT(last, 0.0f);
    for (uint32_t depth = width + 1; depth < 32; ++depth) EXPECT_EQ(f.x[(32 * 65 + 64 - depth) * 3], 0.0f);
}

// The correction falls evenly from the seam to nothing one layer behind the last one.
TEST(CloseSeams, CorrectionsFormARamp) {
    for (const uint32_t width : {1u, 4u, 16u}) {
        float part = 1;
        for (uint32_t depth = 1; depth <= width; ++depth) {
            part *= correction_decay(depth, width);
            EXPECT_NEAR(part, 1 - double(depth) / (width + 1), 1e-5) << depth << " of " << width;
        }
    }
}

TEST(Fuse, SmallImagesKeepTheirMiddle) {
    EXPECT_EQ(diffusion_width(3), 0u);
    EXPECT_EQ(diffusion_width(5), 1u);
    EXPECT_EQ(diffusion_width(9), 2u);
    EXPECT_EQ(diffusion_width(257), 16u);
    Fixture f(5, kTorus, 4);
    const float middle = f.x[(2 * 5 + 2) * 3];
    f.run();
    EXPECT_EQ(f.x[(2 * 5 + 2) * 3], middle);
}

}  // namespace
}  // namespace gim

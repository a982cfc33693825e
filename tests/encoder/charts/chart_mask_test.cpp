#include "encoder/charts/chart_mask.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "encoder/surface/surface_samples.h"
#include "encoder/surface/topology_summary.h"

namespace gim {
namespace {

SampleMask drawn(const std::vector<std::string>& rows) {
    SampleMask mask{static_cast<uint32_t>(rows[0].size()), static_cast<uint32_t>(rows.size()), {}};
    for (const std::string& row : rows) {
        for (const char c : row) mask.defined.push_back(c == '#');
    }
    return mask;
}

// The triangles of section 3 of the paper, for the general topology test.
TopologySummary topology_of(const SampleMask& mask) {
    std::vector<Triangle> triangles;
    const auto number = [&](uint32_t column, uint32_t row) { return row * mask.width + column; };
    for (uint32_t row = 0; row + 1 < mask.height; ++row) {
        for (uint32_t column = 0; column + 1 < mask.width; ++column) {
            const std::array<uint32_t, 4> q{number(column, row), number(column + 1, row), number(column + 1, row + 1),
                                            number(column, row + 1)};
            std::vector<uint32_t> corners;
            for (const uint32_t i : q) {
                if (mask.defined[i]) corners.push_back(i);
            }
            if (corners.size() >= 3) triangles.push_back({corners[0], corners[1], corners[2]});
            if (corners.size() == 4) triangles.push_back({corners[0], corners[2], corners[3]});
        }
    }
    return analyse_topology(triangles, mask.defined.size()).summary;
}

bool is_disk_by_triangles(const SampleMask& mask) {
    const TopologySummary t = topology_of(mask);
    return t.manifold && t.components == 1 && t.boundary_loops == 1 && t.euler == 1 && t.vertices == mask.count();
}

std::vector<Vec2> star(int points, double inner, double outer) {
    std::vector<Vec2> polygon;
    for (int i = 0; i < 2 * points; ++i) {
        const double radius = i % 2 ? inner : outer, angle = 3.14159265 * i / points;
        polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return polygon;
}

TEST(ChartMask, DiskTestAgreesWithTheTopologyOfTheTriangles) {
    // Every mask of 3 x 4 samples, and random ones of 6 x 6.
    for (uint32_t bits = 1; bits < (1u << 12); ++bits) {
        SampleMask mask{4, 3, {}};
        for (uint32_t k = 0; k < 12; ++k) mask.defined.push_back((bits >> k) & 1);
        ASSERT_EQ(mask_is_disk(mask), is_disk_by_triangles(mask)) << bits;
    }
    for (uint64_t seed = 0; seed < 20000; ++seed) {
        const uint64_t bits = mix_bits(seed) | mix_bits(seed + 77777);
        SampleMask mask{6, 6, {}};
        for (uint32_t k = 0; k < 36; ++k) mask.defined.push_back((bits >> k) & 1);
        ASSERT_EQ(mask_is_disk(mask), is_disk_by_triangles(mask)) << seed;
    }
}

TEST(ChartMask, DilationLeavesNoSampleWithoutAFan) {
    for (uint64_t seed = 0; seed < 2000; ++seed) {
        const uint64_t bits = mix_bits(seed) & mix_bits(seed + 77777);
        SampleMask mask{14, 14, std::vector<uint8_t>(196, 0)};
        for (uint32_t k = 0; k < 64; ++k) mask.defined[(3 + k / 8) * 14 + 3 + k % 8] = (bits >> k) & 1;
        const SampleMask before = mask;
        dilate_to_manifold(mask);
        const TopologySummary t = topology_of(mask);
        EXPECT_TRUE(t.nonmanifold_vertices == 0 && t.vertices == mask.count()) << seed;
        for (size_t i = 0; i < mask.defined.size(); ++i) ASSERT_GE(mask.defined[i], before.defined[i]);
    }
}

TEST(ChartMask, ChartsOfManyShapesAndPosesAreDisks) {
    for (const double scale : {1.0, 4.0, 30.0}) {
        for (int k = 0; k < 16; ++k) {
            for (const auto& border : {star(5, 0.4, 1), star(7, 0.9, 1), star(3, 0.15, 1)}) {
                const ChartMask chart = rasterize_chart(border, scale, k * 0.39269908);
                EXPECT_TRUE(chart.is_disk) << scale << " " << k;
                EXPECT_EQ(chart.defined, chart.mask.count());
            }
        }
    }
}

TEST(ChartMask, EverySampleInsideOrNearTheBorderIsDefined) {
    const std::vector<Vec2> square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    const ChartMask chart = rasterize_chart(square, 1, 0);
    EXPECT_EQ(chart.defined, 121u);
    EXPECT_EQ(chart.border_length, 40u);
    // The pose takes the map into the mask: its corner is a corner sample.
    EXPECT_NEAR((chart.pose({0, 0}) - Vec2(0, 0)).norm(), 0, 1e-12);
    EXPECT_NEAR((chart.pose({10, 10}) - Vec2(10, 10)).norm(), 0, 1e-12);
}

TEST(ChartMask, RemovableSamplesLeaveADisk) {
    size_t removed = 0;
    for (uint64_t seed = 0; seed < 20000; ++seed) {
        const uint64_t bits = mix_bits(seed) | mix_bits(seed + 77777);
        SampleMask mask{6, 6, {}};
        for (uint32_t k = 0; k < 36; ++k) mask.defined.push_back((bits >> k) & 1);
        if (!mask_is_disk(mask)) continue;
        for (uint32_t k = 0; k < 36; ++k) {
            if (!can_remove(mask, k) && !is_spike(mask, k)) continue;
            SampleMask without = mask;
            without.defined[k] = 0;
            ASSERT_TRUE(mask_is_disk(without)) << seed << " " << k;
            ++removed;
        }
    }
    EXPECT_GT(removed, 100u);
}

TEST(ChartMask, NarrowInletIsReportedNotHidden) {
    // A ring with a slit far narrower than a sample. Its discrete chart is an annulus in any pose.
    std::vector<Vec2> ring;
    for (int i = 0; i <= 60; ++i) ring.push_back(Vec2(std::cos(i * 0.1047), std::sin(i * 0.1047)));
    for (int i = 60; i >= 0; --i) ring.push_back(0.6 * Vec2(std::cos(i * 0.1047), std::sin(i * 0.1047)));
    EXPECT_FALSE(rasterize_chart(ring, 20, 0.3).is_disk);
}

TEST(ChartMask, BordersRunRoundTheTriangles) {
    const SampleMask mask = drawn({".....", ".###.", ".###.", "..##.", "....."});
    const auto loops = trace_borders(mask);
    ASSERT_EQ(loops.size(), 1u);
    EXPECT_EQ(loops[0], (std::vector<uint32_t>{6, 7, 8, 13, 18, 17, 11}));
    EXPECT_EQ(trace_borders(drawn({"####", "#..#", "#..#", "####"})).size(), 4u);  // the four corners
}

TEST(ChartMask, ChartsBetweenTheSamplesHaveNone) {
    const std::vector<Vec2> border{{0.45, 0.45}, {0.55, 0.45}, {0.5, 0.55}};
    const ChartMask chart = rasterize_chart_on_lattice(border, {}, 0.3);
    EXPECT_FALSE(chart.is_disk);
    EXPECT_EQ(chart.defined, 0u);
}

}  // namespace
}  // namespace gim

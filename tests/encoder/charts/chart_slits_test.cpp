#include "encoder/charts/chart_slits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "encoder/charts/multi_chart.h"
#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

// A sector of a disk of radius 1 with that opening angle, as a fan of thin triangles. Its surface is bent about its
// axis until the two straight sides are `bend` radians apart.
Atlas sector(double opening, double bend) {
    constexpr uint32_t kRays = 60, kRings = 20;
    Atlas atlas;
    Chart chart;
    ChartMap map;
    for (uint32_t ring = 0; ring <= kRings; ++ring) {
        for (uint32_t ray = 0; ray <= kRays; ++ray) {
            const double r = 0.1 + 0.9 * ring / kRings, part = double(ray) / kRays;
            const double angle = (2 * std::numbers::pi - opening) * part,
                         on_surface = (2 * std::numbers::pi - bend) * part;
            map.uv.emplace_back(r * std::cos(angle), r * std::sin(angle));
            chart.mesh.positions.emplace_back(r * std::cos(on_surface), r * std::sin(on_surface), 0);
        }
    }
    const auto at = [](uint32_t ring, uint32_t ray) { return ring * (kRays + 1) + ray; };
    for (uint32_t ring = 0; ring < kRings; ++ring) {
        for (uint32_t ray = 0; ray < kRays; ++ray) {
            chart.mesh.triangles.push_back({at(ring, ray), at(ring + 1, ray), at(ring + 1, ray + 1)});
            chart.mesh.triangles.push_back({at(ring, ray), at(ring + 1, ray + 1), at(ring, ray + 1)});
        }
    }
    for (uint32_t ring = 0; ring < kRings; ++ring) chart.loop.push_back(at(ring, 0));
    for (uint32_t ray = 0; ray < kRays; ++ray) chart.loop.push_back(at(kRings, ray));
    for (uint32_t ring = kRings; ring > 0; --ring) chart.loop.push_back(at(ring, kRays));
    for (uint32_t ray = kRays; ray > 0; --ray) chart.loop.push_back(at(0, ray));
    atlas.charts.push_back(std::move(chart));
    atlas.maps.push_back(std::move(map));
    return atlas;
}

TEST(ChartSlits, AGapThatClosesInTheMapOnlyIsASlit) {
    Atlas atlas = sector(0.05, 1.5);
    EXPECT_EQ(find_slits(0.05, atlas), std::vector<uint32_t>{0});
    ASSERT_TRUE(atlas.maps[0].crossing.has_value());
    // A face at each of the two straight sides.
    const auto ray_of = [&](uint32_t face) { return face / 2 % 60; };
    const auto [a, b] = *atlas.maps[0].crossing;
    EXPECT_EQ(std::min(ray_of(a), ray_of(b)), 0u);
    EXPECT_EQ(std::max(ray_of(a), ray_of(b)), 59u);
}

TEST(ChartSlits, GapsThatAreNarrowOnTheSurfaceTooAreNone) {
    Atlas atlas = sector(0.05, 0.05);
    EXPECT_TRUE(find_slits(0.05, atlas).empty());
    EXPECT_FALSE(atlas.maps[0].crossing.has_value());
}

TEST(ChartSlits, GapsWiderThanASampleAreNone) {
    Atlas atlas = sector(1.5, 1.5);
    EXPECT_TRUE(find_slits(0.05, atlas).empty());
    Atlas fine = sector(0.3, 1.5);
    EXPECT_TRUE(find_slits(0.01, fine).empty());
}

TEST(ChartSlits, TrianglesThatSpanAGapAreFoundWithTheirChart) {
    const Mesh mesh = surfaces()[0].mesh;
    StageClock clock({});
    MultiChartOptions options;
    options.charts = 6;
    options.samples = 5000;
    options.pack_effort = 1;
    options.fit = std::nullopt;
    auto made = make_multi_chart_image(mesh, options, clock);
    ASSERT_TRUE(made.ok()) << made.error().message;
    MultiChart& charts = made.value();
    EXPECT_TRUE(find_bridges(charts.image, charts.packing, mesh, charts.atlas).empty());

    // A sample in the middle of a chart is taken from far away.
    const PlacedChart& placed = charts.packing.charts[2];
    const SampleMask& mask = placed.chart.mask;
    uint32_t inner = kNone;
    for (uint32_t i = 0; i < mask.defined.size() && inner == kNone; ++i) {
        const int64_t column = i % mask.width, row = i / mask.width;
        bool all = true;
        for (int64_t y = row - 2; y <= row + 2; ++y) {
            for (int64_t x = column - 2; x <= column + 2; ++x) all &= mask.at(x, y);
        }
        if (all) inner = (placed.row + i / mask.width) * charts.image.width() + placed.column + i % mask.width;
    }
    ASSERT_NE(inner, kNone);
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : mesh.positions) middle += p / static_cast<double>(mesh.positions.size());
    charts.image.positions[inner] = middle + 3 * (charts.image.positions[inner] - middle);
    EXPECT_EQ(find_bridges(charts.image, charts.packing, mesh, charts.atlas), std::vector<uint32_t>{2});
    EXPECT_TRUE(charts.atlas.maps[2].crossing.has_value());
}

}  // namespace
}  // namespace gim

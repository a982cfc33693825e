#include "encoder/charts/chart_parametrize.h"

#include <gtest/gtest.h>

#include <cmath>

#include "encoder/charts/atlas.h"
#include "encoder/charts/border_barrier.h"
#include "encoder/squares/parametrize.h"
#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

Atlas atlas_of(const Mesh& mesh, uint32_t count, uint32_t threads = 0) {
    AtlasOptions options;
    options.chartify.charts = count;
    options.parametrize.threads = threads;
    auto atlas = build_atlas(mesh, build_topology(mesh), {}, options);
    EXPECT_TRUE(atlas.ok()) << (atlas.ok() ? "" : atlas.error().message);
    return std::move(atlas.value());
}

Chart single_chart(const Mesh& mesh) {
    const Topology topology = build_topology(mesh);
    return take_apart(mesh, topology, {std::vector<uint32_t>(mesh.triangles.size(), 0), 1}).front();
}

TEST(ChartParametrize, NothingIsFlippedAndNoBorderMeetsItself) {
    for (const NamedMesh& m : surfaces()) {
        const Atlas atlas = atlas_of(m.mesh, 8);
        ASSERT_EQ(atlas.charts.size(), atlas.maps.size());
        for (size_t c = 0; c < atlas.charts.size(); ++c) {
            EXPECT_EQ(count_flipped(atlas.charts[c].mesh, atlas.maps[c].uv), 0u) << m.name << " chart " << c;
            std::vector<Vec2> border;
            for (const uint32_t v : atlas.charts[c].loop) border.push_back(atlas.maps[c].uv[v]);
            EXPECT_FALSE(find_crossing(border).has_value()) << m.name << " chart " << c;
            EXPECT_FALSE(atlas.maps[c].overlaps);
        }
    }
}

TEST(ChartParametrize, FlatChartComesBackIsometric) {
    Mesh mesh = clean(corpus::terrain(20)).value().mesh;
    for (Vec3& p : mesh.positions) p = Vec3(p.x() + 0.5 * p.y(), 0.1 * p.x(), 2 * p.y());  // any plane
    const Chart chart = single_chart(mesh);
    const auto map = parametrize_chart(chart, {}, {});
    ASSERT_TRUE(map.ok());
    EXPECT_NEAR(map.value().efficiency(), 1, 1e-6);
    for (const Triangle& t : chart.mesh.triangles) {
        EXPECT_NEAR((map.value().uv[t[0]] - map.value().uv[t[1]]).norm(),
                    (chart.mesh.positions[t[0]] - chart.mesh.positions[t[1]]).norm(), 1e-3);
    }
}

TEST(ChartParametrize, SmoothSurfacesFlattenWell) {
    const Mesh sphere = clean(corpus::sphere(24)).value().mesh;
    const Atlas atlas = atlas_of(sphere, 12);
    EXPECT_GT(stretch_efficiency(atlas.charts, atlas.maps), 0.98);
}

TEST(ChartParametrize, ChartsAreScaledForLeastTotalStretch) {
    const Mesh mesh = clean(corpus::limbed_blob(32)).value().mesh;
    const Atlas atlas = atlas_of(mesh, 10);
    const double best = stretch_efficiency(atlas.charts, atlas.maps);
    for (size_t c = 0; c < atlas.charts.size(); ++c) {
        for (const double scale : {0.9, 1.1}) {
            std::vector<ChartMap> changed = atlas.maps;
            for (Vec2& p : changed[c].uv) p *= scale;
            EXPECT_LT(stretch_efficiency(atlas.charts, changed), best + 1e-9);
        }
    }
}

TEST(ChartParametrize, ImportantFacesGetMoreRoom) {
    Mesh mesh = clean(corpus::terrain(20)).value().mesh;
    for (Vec3& p : mesh.positions) p.z() = 0;
    const Chart chart = single_chart(mesh);
    std::vector<double> importance;
    double middle = 0;
    for (const Vec3& p : mesh.positions) middle += p.x() / static_cast<double>(mesh.positions.size());
    for (const Triangle& t : chart.mesh.triangles)
        importance.push_back(chart.mesh.positions[t[0]].x() > middle ? 4 : 1);
    const auto map = parametrize_chart(chart, importance, {});
    ASSERT_TRUE(map.ok());
    double dense = 0, sparse = 0;
    for (size_t f = 0; f < importance.size(); ++f) {
        const Triangle& t = chart.mesh.triangles[f];
        const Vec2 a = map.value().uv[t[1]] - map.value().uv[t[0]], b = map.value().uv[t[2]] - map.value().uv[t[0]];
        (importance[f] > 1 ? dense : sparse) += a.x() * b.y() - a.y() * b.x();
    }
    EXPECT_GT(dense, 1.3 * sparse);
}

TEST(ChartParametrize, RibbonThatWouldOverlapIsKeptApart) {
    // A spiral ramp of two and a half turns. If it is flattened freely, its turns overlap.
    Mesh mesh;
    constexpr uint32_t kSteps = 120;
    for (uint32_t i = 0; i <= kSteps; ++i) {
        const double angle = 2.5 * 6.283185307 * i / kSteps;
        for (const double radius : {0.6, 0.8, 1.0})
            mesh.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), 0.05 * angle});
    }
    for (uint32_t i = 0; i < kSteps; ++i) {
        for (uint32_t k = 0; k < 2; ++k) {
            const uint32_t a = 3 * i + k;
            mesh.triangles.push_back({a, a + 1, a + 4});
            mesh.triangles.push_back({a, a + 4, a + 3});
        }
    }
    const auto map = parametrize_chart(single_chart(mesh), {}, {});
    ASSERT_TRUE(map.ok());
    EXPECT_TRUE(map.value().crossing.has_value());
    const Atlas atlas = atlas_of(mesh, 1);
    EXPECT_GT(stretch_efficiency(atlas.charts, atlas.maps), 0.95);
}

TEST(ChartParametrize, SameMapsAtAnyThreadCount) {
    const Mesh mesh = clean(corpus::limbed_blob(24)).value().mesh;
    const Atlas one = atlas_of(mesh, 8, 1), many = atlas_of(mesh, 8, 4);
    ASSERT_EQ(one.maps.size(), many.maps.size());
    for (size_t c = 0; c < one.maps.size(); ++c) EXPECT_EQ(one.maps[c].uv, many.maps[c].uv);
}

TEST(FindCrossing, TellsSimplePolygonsFromCrossingOnes) {
    EXPECT_FALSE(find_crossing({{0, 0}, {1, 0}, {1, 1}, {0, 1}}).has_value());
    EXPECT_TRUE(find_crossing({{0, 0}, {1, 1}, {1, 0}, {0, 1}}).has_value());
    EXPECT_TRUE(find_crossing({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}).has_value());  // touches
    EXPECT_FALSE(find_crossing({{0, 0}, {2, 0}, {2, 2}, {1, 0.1}, {0, 2}}).has_value());
}

}  // namespace
}  // namespace gim

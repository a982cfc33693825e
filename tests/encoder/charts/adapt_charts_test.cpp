#include "encoder/charts/adapt_charts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "encoder/surface/stretch.h"
#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

Mesh surface_named(const std::string& name) {
    std::vector<NamedMesh> all = surfaces();
    for (NamedMesh& m : all) {
        if (m.name == name) return std::move(m.mesh);
    }
    ADD_FAILURE() << "no mesh " << name << " in the corpus";
    return {};
}

// Waves that are high in one corner and vanish towards the opposite one.
Mesh wavy_sheet(double height) {
    Mesh sheet = surface_named("terrain-3200");
    for (Vec3& p : sheet.positions)
        p.z() = height * std::max(0.0, p.x() + p.y()) * std::sin(20 * p.x()) * std::sin(20 * p.y());
    return sheet;
}

Atlas atlas_of(const Mesh& mesh) {
    AtlasOptions options;
    options.chartify.charts = 6;
    return std::move(build_atlas(mesh, build_topology(mesh), {}, options).value());
}

double area_of(const std::vector<ChartMap>& maps) {
    double sum = 0;
    for (const ChartMap& map : maps) sum += map.area;
    return sum;
}

TEST(AdaptCharts, ChartsGrowWhereTheSurfaceNeedsSamples) {
    const Mesh mesh = wavy_sheet(0.05);
    const Atlas even = atlas_of(mesh);
    Atlas adapted = even;
    const auto importance = adapt_charts(mesh, 2000, kChartDensity, {}, adapted);
    ASSERT_TRUE(importance.ok()) << importance.error().message;
    ASSERT_EQ(importance.value().size(), mesh.triangles.size());
    // Share of the image / share of the surface, in the wavy half and in the other.
    std::array<double, 2> before{}, after{};
    for (size_t c = 0; c < even.charts.size(); ++c) {
        for (size_t f = 0; f < even.charts[c].source_face.size(); ++f) {
            const Triangle& t = even.charts[c].mesh.triangles[f];
            const Vec3 middle = (even.charts[c].mesh.positions[t[0]] + even.charts[c].mesh.positions[t[1]] +
                                 even.charts[c].mesh.positions[t[2]]) /
                                3;
            const size_t wavy = middle.x() + middle.y() > 0.5;
            before[wavy] += twice_signed_area(even.maps[c].uv[t[0]], even.maps[c].uv[t[1]], even.maps[c].uv[t[2]]);
            after[wavy] +=
                twice_signed_area(adapted.maps[c].uv[t[0]], adapted.maps[c].uv[t[1]], adapted.maps[c].uv[t[2]]);
        }
    }
    EXPECT_GT(after[1] / area_of(adapted.maps), 1.5 * before[1] / area_of(even.maps));
    for (size_t c = 0; c < adapted.charts.size(); ++c) EXPECT_FALSE(adapted.maps[c].overlaps);
}

TEST(AdaptCharts, FlatChartsStayAsTheyAre) {
    const Mesh mesh = wavy_sheet(0);
    const Atlas even = atlas_of(mesh);
    Atlas adapted = even;
    const auto importance = adapt_charts(mesh, 2000, kChartDensity, {}, adapted);
    ASSERT_TRUE(importance.ok());
    if (importance.value().empty()) {
        for (size_t c = 0; c < even.maps.size(); ++c) EXPECT_EQ(adapted.maps[c].uv, even.maps[c].uv);
    }
    EXPECT_NEAR(area_of(adapted.maps) / area_of(even.maps), 1, 0.05);
}

}  // namespace
}  // namespace gim

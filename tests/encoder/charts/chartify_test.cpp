#include "encoder/charts/chartify.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

Chartification charts_of(const Mesh& mesh, uint32_t count, uint64_t seed = 1) {
    return chartify(mesh, build_topology(mesh), {count, seed});
}

TEST(Chartify, EveryChartIsADiskWithASimpleBorder) {
    for (const NamedMesh& m : surfaces()) {
        for (const uint32_t count : {1u, 7u, 40u}) {
            const Chartification charts = charts_of(m.mesh, count);
            EXPECT_TRUE(charts_are_disks(m.mesh, build_topology(m.mesh), charts)) << m.name << " " << count;
        }
    }
}

TEST(Chartify, GivesTheChartsAskedForWhereTopologyAllowsIt) {
    for (const NamedMesh& m : connected_meshes()) {
        if (m.genus != 0 || m.boundary_loops != 0 || m.mesh.triangles.size() < 700) continue;
        const uint32_t count = charts_of(m.mesh, 12).count;
        EXPECT_GE(count, 9u) << m.name;
        EXPECT_LE(count, 14u) << m.name;
    }
}

TEST(Chartify, ClosedSphereNeedsTwoChartsAndADiskOne) {
    EXPECT_GE(charts_of(clean(corpus::sphere(6)).value().mesh, 1).count, 2u);
    EXPECT_EQ(charts_of(clean(corpus::disk(7, 12)).value().mesh, 1).count, 1u);
}

TEST(Chartify, FollowsTheEdgesOfABox) {
    const Mesh mesh = clean(corpus::box(16, 0.8, 0.5)).value().mesh;
    EXPECT_LT(mean_normal_deviation(mesh, charts_of(mesh, 12)), 0.02);
}

TEST(Chartify, MoreChartsAreFlatter) {
    const Mesh mesh = clean(corpus::sphere(20)).value().mesh;
    EXPECT_LT(mean_normal_deviation(mesh, charts_of(mesh, 24)), mean_normal_deviation(mesh, charts_of(mesh, 6)));
}

TEST(Chartify, SameSeedSameCharts) {
    const Mesh mesh = clean(corpus::limbed_blob(24)).value().mesh;
    EXPECT_EQ(charts_of(mesh, 9, 5).chart_of_face, charts_of(mesh, 9, 5).chart_of_face);
}

TEST(Chartify, SplittingAChartLeavesDisksAndTheOtherChartsAlone) {
    for (const NamedMesh& m : surfaces()) {
        const Topology topology = build_topology(m.mesh);
        const Chartification before = charts_of(m.mesh, 5);
        Chartification after = before;
        const uint32_t victim = before.count / 2;
        const bool single = std::count(before.chart_of_face.begin(), before.chart_of_face.end(), victim) == 1;
        split_chart(m.mesh, topology, victim, {kNone, kNone}, after);
        EXPECT_TRUE(charts_are_disks(m.mesh, topology, after)) << m.name;
        if (!single) {
            EXPECT_GT(after.count, before.count) << m.name;
        }
        for (size_t f = 0; f < after.chart_of_face.size(); ++f) {
            if (before.chart_of_face[f] != victim) {
                ASSERT_EQ(after.chart_of_face[f], before.chart_of_face[f]);
            }
        }
    }
}

TEST(Chartify, DiskTestRefusesAnnuliPinchesAndClosedCharts) {
    const auto whole = [](const TriangleMesh& input) {
        const Mesh mesh = clean(input).value().mesh;
        return charts_are_disks(mesh, build_topology(mesh), {std::vector<uint32_t>(mesh.triangles.size(), 0), 1});
    };
    EXPECT_TRUE(whole(corpus::disk(4, 9)));
    EXPECT_FALSE(whole(corpus::annulus(4, 16, 0.5)));
    EXPECT_FALSE(whole(corpus::sphere(4)));
    EXPECT_FALSE(whole(corpus::torus(16, 8, 0.7, 0.3)));
    // Two opposite faces of a hexagon's fan touch at the centre only.
    Mesh fan;
    fan.positions.push_back(Vec3::Zero());
    for (int i = 0; i < 6; ++i) fan.positions.push_back({std::cos(i * 1.0471975512), std::sin(i * 1.0471975512), 0});
    for (uint32_t i = 0; i < 6; ++i) fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % 6});
    const Topology topology = build_topology(fan);
    EXPECT_FALSE(charts_are_disks(fan, topology, {{0, 1, 2, 0, 3, 4}, 5}));
    EXPECT_TRUE(charts_are_disks(fan, topology, {{0, 0, 0, 1, 1, 1}, 2}));
}

}  // namespace
}  // namespace gim

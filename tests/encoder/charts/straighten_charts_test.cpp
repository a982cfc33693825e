#include "encoder/charts/straighten_charts.h"

#include <gtest/gtest.h>

#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

double seam_length(const Mesh& mesh, const Topology& topology, const Chartification& charts) {
    double length = 0;
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        const uint32_t twin = topology.twin[h];
        if (twin != kNone && h < twin && charts.chart_of_face[face_of(h)] != charts.chart_of_face[face_of(twin)])
            length += (mesh.positions[to(mesh, h)] - mesh.positions[from(mesh, h)]).norm();
    }
    return length;
}

TEST(StraightenCharts, BordersGetShorterAndChartsStayDisks) {
    for (const NamedMesh& m : surfaces()) {
        const Topology topology = build_topology(m.mesh);
        Chartification charts = chartify(m.mesh, topology, {10, 3});
        const uint32_t count = charts.count;
        const double before = seam_length(m.mesh, topology, charts);
        straighten_charts(m.mesh, topology, {.band = 0.3, .crease = 0, .passes = 2}, charts);
        EXPECT_EQ(charts.count, count);
        EXPECT_TRUE(charts_are_disks(m.mesh, topology, charts)) << m.name;
        EXPECT_LE(seam_length(m.mesh, topology, charts), before * (1 + 1e-9)) << m.name;
    }
}

TEST(StraightenCharts, RaggedBorderBecomesStraight) {
    // A flat strip cut in two along a zigzag; the straight cut is 1 long.
    Mesh mesh = clean(corpus::terrain(24)).value().mesh;
    for (Vec3& p : mesh.positions) p.z() = 0;
    const Topology topology = build_topology(mesh);
    Vec3 low = mesh.positions[0], high = low;
    for (const Vec3& p : mesh.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
    Chartification charts{std::vector<uint32_t>(mesh.triangles.size(), 0), 2};
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
        Vec3 centre = Vec3::Zero();
        for (const uint32_t v : mesh.triangles[f]) centre += mesh.positions[v] / 3;
        const double x = (centre.x() - low.x()) / (high.x() - low.x()),
                     y = (centre.y() - low.y()) / (high.y() - low.y());
        charts.chart_of_face[f] = x > 0.5 + 0.12 * std::sin(12.566370614 * y);
    }
    ASSERT_TRUE(charts_are_disks(mesh, topology, charts));
    const double before = seam_length(mesh, topology, charts);
    straighten_charts(mesh, topology, {.band = 1, .crease = 0, .passes = 2}, charts);
    EXPECT_LT(seam_length(mesh, topology, charts), 0.8 * before);
}

}  // namespace
}  // namespace gim

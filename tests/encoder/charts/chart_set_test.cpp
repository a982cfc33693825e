#include "encoder/charts/chart_set.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

std::vector<Chart> apart(const Mesh& mesh, uint32_t count) {
    const Topology topology = build_topology(mesh);
    return take_apart(mesh, topology, chartify(mesh, topology, {count, 1}));
}

// The surface's vertices along a path, both ends included.
std::vector<uint32_t> vertices_of(const Chart& chart, size_t path) {
    std::vector<uint32_t> vertices;
    for (uint32_t i = chart.paths[path].first; i <= chart.path_end(path); ++i)
        vertices.push_back(chart.source_vertex[chart.loop[i % chart.loop.size()]]);
    return vertices;
}

TEST(ChartSet, ChartsHoldEveryFaceOnceWithItsCorners) {
    for (const NamedMesh& m : surfaces()) {
        std::set<uint32_t> faces;
        for (const Chart& chart : apart(m.mesh, 9)) {
            EXPECT_EQ(euler_characteristic(chart.mesh), 1) << m.name;
            for (size_t f = 0; f < chart.source_face.size(); ++f) {
                faces.insert(chart.source_face[f]);
                for (size_t i = 0; i < 3; ++i) {
                    ASSERT_EQ(chart.source_vertex[chart.mesh.triangles[f][i]],
                              m.mesh.triangles[chart.source_face[f]][i]);
                }
            }
        }
        EXPECT_EQ(faces.size(), m.mesh.triangles.size()) << m.name;
    }
}

TEST(ChartSet, MatesRunAlongTheSameVerticesTheOtherWay) {
    for (const NamedMesh& m : surfaces()) {
        const std::vector<Chart> charts = apart(m.mesh, 9);
        size_t unmated_edges = 0;
        for (uint32_t c = 0; c < charts.size(); ++c) {
            for (uint32_t p = 0; p < charts[c].paths.size(); ++p) {
                const ChartPath& path = charts[c].paths[p];
                std::vector<uint32_t> own = vertices_of(charts[c], p);
                EXPECT_EQ(own.front(), path.begin_node);
                EXPECT_EQ(own.back(), path.end_node);
                if (path.mate_chart == kNoMate) {
                    unmated_edges += own.size() - 1;
                    continue;
                }
                const ChartPath& mate = charts[path.mate_chart].paths[path.mate_path];
                EXPECT_EQ(mate.mate_chart, c);
                EXPECT_EQ(mate.mate_path, p);
                EXPECT_NE(path.mate_chart, c) << m.name;
                const std::vector<uint32_t> other = vertices_of(charts[path.mate_chart], path.mate_path);
                EXPECT_TRUE(std::equal(own.begin(), own.end(), other.rbegin(), other.rend())) << m.name;
            }
        }
        size_t boundary_edges = 0;
        for (const uint32_t t : build_topology(m.mesh).twin) boundary_edges += t == kNone;
        EXPECT_EQ(unmated_edges, boundary_edges) << m.name;
    }
}

TEST(ChartSet, TwoHalvesOfASphereMeetInThreeCutNodes) {
    const Mesh mesh = clean(corpus::sphere(8)).value().mesh;
    const std::vector<Chart> charts = apart(mesh, 2);
    ASSERT_EQ(charts.size(), 2u);
    for (const Chart& chart : charts) EXPECT_EQ(chart.paths.size(), 3u);
}

}  // namespace
}  // namespace gim

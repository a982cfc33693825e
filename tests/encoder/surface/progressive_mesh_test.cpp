#include "encoder/surface/progressive_mesh.h"

#include <gtest/gtest.h>

#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

TEST(ProgressiveMesh, CoarseMeshKeepsTopologyAndBoundary) {
    for (const NamedMesh& m : connected_meshes()) {
        ProgressiveMesh hierarchy(m.mesh);
        simplify(hierarchy, m.mesh.positions, {hierarchy.vertex_count() / 4, false, {}});
        EXPECT_LT(hierarchy.vertex_count(), m.mesh.positions.size()) << m.name;
        const ProgressiveMesh::Compacted coarse = hierarchy.compact(m.mesh.positions);
        EXPECT_EQ(euler_characteristic(coarse.mesh), euler_characteristic(m.mesh)) << m.name;
        const Topology fine = build_topology(m.mesh), topology = build_topology(coarse.mesh);
        const auto open_edges = [](const Topology& t) { return std::count(t.twin.begin(), t.twin.end(), kNone); };
        EXPECT_EQ(open_edges(topology), open_edges(fine)) << m.name;
    }
}

TEST(ProgressiveMesh, SplittingEverythingGivesTheInputBack) {
    for (const NamedMesh& m : connected_meshes()) {
        ProgressiveMesh hierarchy(m.mesh);
        simplify(hierarchy, m.mesh.positions, {4, true, {}});
        ASSERT_TRUE(hierarchy.coarsened()) << m.name;
        while (hierarchy.coarsened()) (void)hierarchy.split();
        const Topology topology = build_topology(m.mesh);
        for (uint32_t h = 0; h < topology.twin.size(); ++h) {
            ASSERT_EQ(hierarchy.origin(h), from(m.mesh, h)) << m.name;
            ASSERT_EQ(hierarchy.twin(h), topology.twin[h]) << m.name;
        }
    }
}

TEST(ProgressiveMesh, NoCollapseJoinsTwoVerticesOfOneSide) {
    // A flat fan: four boundary vertices around one interior vertex. The boundary is all on one side of the square.
    const Mesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0)},
                    {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}}};
    ProgressiveMesh allowed(mesh), refused(mesh);
    simplify(allowed, mesh.positions, {4, true, {0, 1, 2, 4, 8}});
    simplify(refused, mesh.positions, {4, true, {0, 1, 1, 1, 1}});
    EXPECT_EQ(allowed.vertex_count(), 4u);
    EXPECT_EQ(refused.vertex_count(), 5u);
}

}  // namespace
}  // namespace gim

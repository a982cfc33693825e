#include "encoder/surface/mesh.h"

#include <gtest/gtest.h>

namespace gim {
namespace {

TEST(Topology, ClosedTetrahedronHasNoBoundary) {
    const Mesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
                    {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
    const Topology topology = build_topology(mesh);
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        ASSERT_NE(topology.twin[h], kNone);
        EXPECT_EQ(topology.twin[topology.twin[h]], h);
        EXPECT_EQ(from(mesh, h), to(mesh, topology.twin[h]));
    }
}

TEST(Topology, WalkFromOutgoingMeetsEveryFaceOfABoundaryVertex) {
    // A fan of three triangles around vertex 0, open on both sides.
    const Mesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0), Vec3(-1, 0, 0)},
                    {{2, 3, 0}, {0, 1, 2}, {3, 4, 0}}};
    const Topology topology = build_topology(mesh);
    int faces = 0;
    for (uint32_t h = topology.outgoing[0]; h != kNone; h = topology.twin[prev(h)]) ++faces;
    EXPECT_EQ(faces, 3);
}

}  // namespace
}  // namespace gim

#include "encoder/squares/open_mesh.h"

#include <gtest/gtest.h>

#include "encoder/squares/cut.h"
#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

TEST(OpenMesh, IsADiskWithTheSameFaces) {
    for (const NamedMesh& m : connected_meshes()) {
        const Topology topology = build_topology(m.mesh);
        const auto opened = open_mesh(m.mesh, topology, initial_cut(m.mesh, topology, 0));
        ASSERT_TRUE(opened.ok()) << m.name << ": " << opened.error().message;
        const OpenedMesh& disk = opened.value();
        EXPECT_EQ(euler_characteristic(disk.mesh), 1) << m.name;
        ASSERT_EQ(disk.mesh.triangles.size(), m.mesh.triangles.size());
        for (size_t f = 0; f < m.mesh.triangles.size(); ++f) {
            for (size_t i = 0; i < 3; ++i) EXPECT_EQ(disk.source[disk.mesh.triangles[f][i]], m.mesh.triangles[f][i]);
        }
    }
}

TEST(OpenMesh, LoopRunsAlongBoundaryEdges) {
    for (const NamedMesh& m : connected_meshes()) {
        const Topology topology = build_topology(m.mesh);
        const OpenedMesh disk = open_mesh(m.mesh, topology, initial_cut(m.mesh, topology, 0)).value();
        const Topology opened = build_topology(disk.mesh);
        for (size_t i = 0; i < disk.loop.size(); ++i) {
            const uint32_t h = opened.outgoing[disk.loop[i]];
            ASSERT_EQ(opened.twin[h], kNone) << m.name;
            EXPECT_EQ(to(disk.mesh, h), disk.loop[(i + 1) % disk.loop.size()]) << m.name;
        }
    }
}

TEST(OpenMesh, MatesRunThroughTheSameVerticesInOppositeOrder) {
    for (const NamedMesh& m : connected_meshes()) {
        const Topology topology = build_topology(m.mesh);
        const OpenedMesh disk = open_mesh(m.mesh, topology, initial_cut(m.mesh, topology, 0)).value();
        const auto vertices = [&](size_t k) {
            const size_t end = k + 1 < disk.paths.size() ? disk.paths[k + 1].first : disk.loop.size();
            std::vector<uint32_t> run;
            for (size_t i = disk.paths[k].first; i <= end; ++i)
                run.push_back(disk.source[disk.loop[i % disk.loop.size()]]);
            return run;
        };
        for (size_t k = 0; k < disk.paths.size(); ++k) {
            const uint32_t mate = disk.paths[k].mate;
            if (mate == kNoMate) continue;
            std::vector<uint32_t> other = vertices(mate);
            std::reverse(other.begin(), other.end());
            EXPECT_EQ(vertices(k), other) << m.name << " path " << k;
        }
    }
}

TEST(OpenMesh, CutThatLeavesAnAnnulusIsRefused) {
    const Mesh mesh = clean(corpus::torus(20, 10, 1, 0.4)).value().mesh;
    const Topology topology = build_topology(mesh);
    CutEdges cut = initial_cut(mesh, topology, 0);
    // Removes one whole cut-path. The rest opens the torus into an annulus.
    const std::vector<uint32_t> valence = cut_valence(mesh, topology, cut);
    uint32_t h = 0;
    while (!cut[h] || valence[from(mesh, h)] == 2) ++h;
    for (uint32_t e = h;;) {
        const uint32_t following = next_on_cut(topology, cut, e);
        const bool last = valence[to(mesh, e)] != 2;
        mark_path(topology, {e}, 0, cut);
        if (last) break;
        e = following;
    }
    EXPECT_FALSE(opens_to_disk(mesh, topology, cut));
    EXPECT_FALSE(open_mesh(mesh, topology, cut).ok());
}

}  // namespace
}  // namespace gim

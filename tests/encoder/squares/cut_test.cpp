#include "encoder/squares/cut.h"

#include <gtest/gtest.h>

#include "encoder/squares/augment_cut.h"
#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

bool is_closed(const NamedMesh& m) { return m.boundary_loops == 0; }

TEST(Cut, InitialCutOpensEverySurfaceIntoADisk) {
    for (const NamedMesh& m : connected_meshes()) {
        const Topology topology = build_topology(m.mesh);
        EXPECT_TRUE(opens_to_disk(m.mesh, topology, initial_cut(m.mesh, topology, 0))) << m.name;
    }
}

TEST(Cut, NoDanglingEdgeIsLeftByTheInitialCutOfHigherGenus) {
    for (const NamedMesh& m : connected_meshes()) {
        if (m.genus == 0) continue;
        const Topology topology = build_topology(m.mesh);
        for (const uint32_t valence : cut_valence(m.mesh, topology, initial_cut(m.mesh, topology, 0)))
            EXPECT_NE(valence, 1u) << m.name;
    }
}

TEST(Cut, ClosedSurfaceOfGenusZeroIsCutAlongTwoEdges) {
    for (const NamedMesh& m : connected_meshes()) {
        if (m.genus != 0 || !is_closed(m)) continue;
        const Topology topology = build_topology(m.mesh);
        const CutEdges cut = initial_cut(m.mesh, topology, 0);
        EXPECT_EQ(std::count(cut.begin(), cut.end(), 1), 4) << m.name;  // two edges, both half-edges of each
    }
}

TEST(Cut, StraighteningShortensAndKeepsTheDisk) {
    for (const NamedMesh& m : connected_meshes()) {
        const Topology topology = build_topology(m.mesh);
        const CutEdges cut = initial_cut(m.mesh, topology, 0);
        const CutEdges straight = straighten_cut(m.mesh, topology, cut);
        EXPECT_TRUE(opens_to_disk(m.mesh, topology, straight)) << m.name;
        EXPECT_LE(cut_length(m.mesh, topology, straight), cut_length(m.mesh, topology, cut) * (1 + 1e-12)) << m.name;
    }
}

TEST(Cut, ExchangingPathsShortensAndKeepsTheDisk) {
    for (const NamedMesh& m : connected_meshes()) {
        if (m.mesh.triangles.size() > 6000) continue;  // made for coarse meshes
        const Topology topology = build_topology(m.mesh);
        const CutEdges cut = initial_cut(m.mesh, topology, 0);
        const CutEdges shorter = shorten_cut(m.mesh, topology, cut);
        EXPECT_TRUE(opens_to_disk(m.mesh, topology, shorter)) << m.name;
        EXPECT_LE(cut_length(m.mesh, topology, shorter), cut_length(m.mesh, topology, cut) * (1 + 1e-12)) << m.name;
    }
}

TEST(Cut, HalvesOfACutEdgeAreMarkedAlike) {
    for (const NamedMesh& m : connected_meshes()) {
        const Topology topology = build_topology(m.mesh);
        const CutEdges cut = straighten_cut(m.mesh, topology, initial_cut(m.mesh, topology, 0));
        for (uint32_t h = 0; h < cut.size(); ++h) {
            if (topology.twin[h] == kNone) {
                EXPECT_EQ(cut[h], 0) << m.name;
            } else {
                EXPECT_EQ(cut[h], cut[topology.twin[h]]) << m.name;
            }
        }
    }
}

TEST(FindCut, OpensEverySurfaceIntoADisk) {
    for (const NamedMesh& m : connected_meshes()) {
        const Topology topology = build_topology(m.mesh);
        // Far fewer faces than the meshes have: the cut must survive the way back to the full mesh.
        const auto found = find_cut(m.mesh, topology, coarsen(m.mesh, 300), {});
        ASSERT_TRUE(found.ok()) << m.name << ": " << found.error().message;
        EXPECT_TRUE(opens_to_disk(m.mesh, topology, found.value().cut)) << m.name;
    }
}

TEST(FindCut, ReachesTheLimbs) {
    const auto cleaned = clean(corpus::limbed_blob(30));
    ASSERT_TRUE(cleaned.ok());
    const Mesh& mesh = cleaned.value().mesh;
    const Topology topology = build_topology(mesh);
    const auto found = find_cut(mesh, topology, coarsen(mesh, kSearchVertices), {});
    ASSERT_TRUE(found.ok());
    const std::vector<uint32_t> valence = cut_valence(mesh, topology, found.value().cut);
    EXPECT_GE(std::count(valence.begin(), valence.end(), 1u), 4) << "leaves of the cut, of five limbs";
    EXPECT_GT(found.value().steps.back().efficiency, found.value().steps[2].efficiency);
}

TEST(FindCut, WhatPathsCostDecidesHowManyThereAre) {
    const Mesh mesh = clean(corpus::limbed_blob(30)).value().mesh;
    const Topology topology = build_topology(mesh);
    const CoarseSurface coarse = coarsen(mesh, kSearchVertices);
    const auto leaves = [&](double path_cost) {
        AugmentOptions options;
        options.path_cost = path_cost;
        const CutEdges cut = find_cut(mesh, topology, coarse, options).value().cut;
        const std::vector<uint32_t> valence = cut_valence(mesh, topology, cut);
        return std::count(valence.begin(), valence.end(), 1u);
    };
    EXPECT_LT(leaves(0.2), leaves(0));
}

TEST(FindCut, SameCutTwice) {
    const Mesh mesh = clean(corpus::torus(40, 20, 1, 0.4)).value().mesh;
    const Topology topology = build_topology(mesh);
    const CoarseSurface coarse = coarsen(mesh, kSearchVertices);
    EXPECT_EQ(find_cut(mesh, topology, coarse, {}).value().cut, find_cut(mesh, topology, coarse, {}).value().cut);
}

}  // namespace
}  // namespace gim

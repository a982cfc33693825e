// Bases of many small surfaces, whole and with holes, at all sizes.
#include "encoder/tiles/tile_base.h"

#include <gtest/gtest.h>

#include <random>

#include "corpus/generators.h"
#include "encoder/surface/topology_summary.h"
#include "tests/encoder/tiles/mapped_meshes.h"

namespace gim {
namespace {

Mesh cleaned(const TriangleMesh& mesh) { return clean(mesh, {.require_connected = false}).value().mesh; }

// One of several kinds of surfaces, of a size by chance. Up to a quarter of its faces are taken away.
Mesh random_surface(uint32_t seed) {
    std::mt19937 random(seed);
    const auto below = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
    const uint32_t size = 1 + below(5), around = 3 + below(8);
    const auto whole = [&] {
        switch (seed % 8) {
            case 0:
                return corpus::sphere(size + 1);
            case 1:
                return corpus::torus(around, 3 + size, 0.7, 0.3);
            case 2:
                return corpus::plate_with_holes(size, 1 + size % 3);
            case 3:
                return corpus::disk(size, around);
            case 4:
                return corpus::open_cylinder(size, around, 1);
            case 5:
                return corpus::box(size, 1, 0.5);
            case 6:
                return corpus::annulus(size, around, 0.5);
            default:
                return corpus::terrain(2 * size);
        }
    };
    TriangleMesh mesh = whole();
    const uint32_t percent = 8 * below(4);
    std::vector<std::array<uint32_t, 3>> kept;
    for (const auto& t : mesh.triangles) {
        if (kept.empty() || below(100) >= percent) kept.push_back(t);
    }
    mesh.triangles = kept;
    return cleaned(mesh);
}

TEST(TileBase, EverySurfacePairsAtEverySize) {
    for (uint32_t seed = 0; seed < 40; ++seed) {
        const Mesh mesh = random_surface(seed);
        TileInput input = make_room_for_tiles(mesh, {});
        split_chords(input.mesh, input.sharp);
        const BaseHierarchy hierarchy(input.mesh, input.sharp);
        const TopologySummary expected = analyse_topology(mesh.triangles, mesh.positions.size()).summary;
        for (const uint32_t tiles : {1u, 20u, 100u}) {
            const TileBase made = make_tile_base(input, hierarchy, 2 * tiles);
            EXPECT_TRUE(made.pairing.unpaired.empty()) << seed << " " << tiles;
            EXPECT_EQ(2 * made.pairing.quads.size(), made.base.triangles.size()) << seed << " " << tiles;
            EXPECT_EQ(made.pairing.twins, 0u) << seed << " " << tiles;
            const TopologySummary now = analyse_topology(made.base.triangles, input.mesh.positions.size()).summary;
            EXPECT_TRUE(now.manifold) << seed << " " << tiles;
            EXPECT_EQ(now.euler, expected.euler) << seed << " " << tiles;
            EXPECT_EQ(now.components, expected.components) << seed << " " << tiles;
            EXPECT_EQ(now.boundary_loops, expected.boundary_loops) << seed << " " << tiles;
        }
    }
}

// A base that is too coarse for its handles would lose most vertices.
TEST(TileBase, SmallestBasesOfManyHandlesKeepAllVertices) {
    for (const TriangleMesh& part : {corpus::plate_with_holes(5, 4), corpus::plate_with_holes(5, 2),
                                     corpus::plate_with_holes(6, 3), corpus::melted_tori(5, 32)}) {
        const MappedMesh m = mapped(cleaned(part), 12);
        ASSERT_FALSE(m.map.quads.empty()) << part.triangles.size();
        EXPECT_LE(m.map.left_out.size(), 2u) << part.triangles.size();
    }
}

TEST(TileBase, BoundariesKeepTheirVertices) {
    const Mesh mesh = cleaned(corpus::terrain(20));
    for (const uint32_t tiles : {24u, 48u, 80u}) {
        const MappedMesh m = mapped(mesh, tiles);
        ASSERT_FALSE(m.map.quads.empty()) << tiles;
        EXPECT_LE(m.map.left_out.size(), 2u) << tiles;
    }
}

// A face between two edges of a boundary would be flat: a side of a tile is straight.
TEST(TileBase, NoWellShapedCollapseTakesAnEarOfABoundary) {
    for (const TriangleMesh& open : {corpus::terrain(12), corpus::disk(4, 9), corpus::sphere_with_holes(6, 3)}) {
        TileInput input = make_room_for_tiles(cleaned(open), {});
        split_chords(input.mesh, input.sharp);
        const BaseHierarchy hierarchy(input.mesh, input.sharp);
        for (uint32_t count = 0; count < hierarchy.well_shaped(); ++count) {
            const HalfEdgeCollapse& next = hierarchy.collapses()[count];
            if (next.left != kNone && next.right != kNone) continue;
            size_t faces = 0;
            for (const Triangle& t : hierarchy.cut(input.mesh, count).triangles)
                faces += std::find(t.begin(), t.end(), next.vertex) != t.end();
            EXPECT_GE(faces, 2u) << count;
        }
    }
}

}  // namespace
}  // namespace gim

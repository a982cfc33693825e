#include "encoder/tiles/pair_triangles.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "corpus/generators.h"
#include "encoder/tiles/perfect_matching.h"
#include "encoder/tiles/tile_base.h"
#include "tests/encoder/stage_meshes.h"
#include "tests/encoder/tiles/base_undo.h"

namespace gim {
namespace {

Mesh cleaned(const TriangleMesh& mesh) { return clean(mesh, {.require_connected = false}).value().mesh; }

TileBase tiles_of(const TileInput& input, uint32_t triangles) {
    return make_tile_base(input, BaseHierarchy(input.mesh, input.sharp), triangles);
}

// Every triangle is in one quad, and the quads are an oriented surface of the base's topology.
void expect_sound(const TileInput& input, const TileBase& tiles, const std::string& name) {
    const QuadPairing& p = tiles.pairing;
    EXPECT_TRUE(p.unpaired.empty()) << name;
    ASSERT_EQ(2 * p.quads.size(), tiles.base.triangles.size()) << name;
    std::vector<int> used(tiles.base.triangles.size(), 0);
    std::map<std::pair<uint32_t, uint32_t>, int> ways;
    std::map<uint32_t, int> quads_at;
    for (size_t i = 0; i < p.quads.size(); ++i) {
        const auto& q = p.quads[i];
        for (const uint32_t t : p.triangles[i]) ++used[t];
        EXPECT_EQ(normal_form({{q[0], q[1], q[2]}}), normal_form({tiles.base.triangles[p.triangles[i][0]]})) << name;
        EXPECT_EQ(normal_form({{q[0], q[2], q[3]}}), normal_form({tiles.base.triangles[p.triangles[i][1]]})) << name;
        for (uint32_t k = 0; k < 4; ++k) ++ways[{q[k], q[(k + 1) % 4]}], ++quads_at[q[k]];
    }
    for (const int count : used) EXPECT_EQ(count, 1) << name;
    int64_t edges = 0;
    for (const auto& [way, count] : ways) {
        EXPECT_EQ(count, 1) << name;
        const bool other_way = ways.count({way.second, way.first}) != 0;
        edges += !other_way || way.first < way.second;
    }
    const auto vertices = static_cast<int64_t>(quads_at.size());
    EXPECT_EQ(vertices - edges + static_cast<int64_t>(p.quads.size()), euler_characteristic(input.mesh)) << name;
    EXPECT_EQ(p.twins, 0u) << name;
    const Topology topology = build_topology({input.mesh.positions, tiles.base.triangles});
    std::vector<uint32_t> doublets;
    for (const auto& [v, count] : quads_at) {
        if (count == 2 && topology.twin[topology.outgoing[v]] != kNone) doublets.push_back(v);
    }
    EXPECT_EQ(p.doublets, doublets) << name;
}

TEST(PerfectMatching, TakesTheHeaviestPairs) {
    // A path of four: the two outer edges are the only perfect matching, however light they are.
    EXPECT_EQ(perfect_matching(4, {{0, 1, 1}, {1, 2, 100}, {2, 3, 1}}), (std::vector<uint32_t>{1, 0, 3, 2}));
    // A cycle of four has two.
    EXPECT_EQ(perfect_matching(4, {{0, 1, 1}, {1, 2, 5}, {2, 3, 1}, {3, 0, 5}}), (std::vector<uint32_t>{3, 2, 1, 0}));
    EXPECT_TRUE(perfect_matching(3, {{0, 1, 1}, {1, 2, 1}}).empty());
    EXPECT_TRUE(perfect_matching(4, {{0, 1, 1}, {0, 2, 1}, {0, 3, 1}}).empty());
}

TEST(PairTriangles, SquareOfTwoTrianglesIsOneQuad) {
    const std::vector<Vec3> positions{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
    BaseMesh base;
    base.triangles = {{0, 1, 2}, {0, 2, 3}};
    const QuadPairing pairing = pair_triangles(positions, base);
    ASSERT_EQ(pairing.quads.size(), 1u);
    EXPECT_EQ(std::min(pairing.quads[0][0], pairing.quads[0][2]), 0u);
    EXPECT_EQ(std::max(pairing.quads[0][0], pairing.quads[0][2]), 2u);
    EXPECT_TRUE(pairing.doublets.empty());
}

TEST(PairTriangles, LoneTriangleStaysUnpaired) {
    BaseMesh base;
    base.triangles = {{0, 1, 2}};
    const QuadPairing pairing = pair_triangles({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, base);
    EXPECT_TRUE(pairing.quads.empty());
    EXPECT_EQ(pairing.unpaired, std::vector<uint32_t>{0});
}

TEST(PairTriangles, TetrahedronReportsItsDoublets) {
    BaseMesh base;
    base.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const std::vector<Vec3> positions{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    const QuadPairing pairing = pair_triangles(positions, base);
    EXPECT_EQ(pairing.quads.size(), 2u);
    EXPECT_EQ(pairing.doublets.size(), 4u);
    EXPECT_EQ(pairing.twins, 1u);
}

TEST(PairTriangles, CreaseIsNoDiagonalWhereAnotherWayExists) {
    // A strip of four triangles; the crease is where the best pair would meet.
    const std::vector<Vec3> positions{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0),
                                      Vec3(0, 1, 0), Vec3(2, 0, 0), Vec3(2, 1, 0)};
    BaseMesh base;
    base.triangles = {{0, 1, 3}, {1, 2, 3}, {1, 4, 2}, {4, 5, 2}};
    base.creases = {{1, 2}};
    const QuadPairing pairing = pair_triangles(positions, base);
    EXPECT_EQ(pairing.quads.size(), 2u);
    EXPECT_TRUE(pairing.crossed.empty());
    // With the crease at the only place for a pair it must be crossed, and that is said.
    base.creases = {{1, 3}};
    EXPECT_EQ(pair_triangles(positions, base).crossed, base.creases);
}

TEST(TileBase, QuadsOfAllSurfacesAreSound) {
    for (const NamedMesh& m : surfaces()) {
        const TileInput input = make_room_for_tiles(m.mesh, {});
        for (const uint32_t triangles : {60u, 200u}) {
            const TileBase tiles = tiles_of(input, triangles);
            expect_sound(input, tiles, m.name + " " + std::to_string(triangles));
            EXPECT_LE(tiles.pairing.doublets.size(), 1u) << m.name << " " << triangles;
            BaseUndo undo(tiles.base, input.mesh.positions.size());
            for (size_t i = tiles.base.collapses.size(); i-- > 0;) ASSERT_TRUE(undo.undo(tiles.base.collapses[i]));
            EXPECT_EQ(normal_form(undo.triangles()), normal_form(input.mesh.triangles)) << m.name;
        }
    }
}

TEST(TileBase, CreasesOfMachinedPartsAreSidesOfQuads) {
    for (const TriangleMesh& part :
         {corpus::box(8, 0.6, 0.3), corpus::plate_with_holes(1, 4), corpus::plate_with_holes(3, 5)}) {
        const Mesh mesh = cleaned(part);
        const TileInput input = make_room_for_tiles(mesh, find_creases(mesh, std::numbers::pi / 4));
        const TileBase tiles = tiles_of(input, 140);
        expect_sound(input, tiles, std::to_string(mesh.triangles.size()));
        EXPECT_TRUE(tiles.pairing.crossed.empty()) << mesh.triangles.size();
    }
}

TEST(TileBase, CubeIsSixQuads) {
    const Mesh mesh = cleaned(corpus::box(6, 1, 1));
    const TileInput input = make_room_for_tiles(mesh, find_creases(mesh, std::numbers::pi / 4));
    const TileBase tiles = tiles_of(input, 12);
    EXPECT_EQ(tiles.pairing.quads.size(), 6u);
    EXPECT_TRUE(tiles.pairing.crossed.empty());
    EXPECT_TRUE(tiles.pairing.doublets.empty());
}

TEST(TileBase, SmallestInputsBecomeTiles) {
    const Mesh tetrahedron{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
                           {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    const Mesh triangle{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}};
    Mesh with_hole = cleaned(corpus::sphere(6));
    with_hole.triangles.pop_back();
    for (const Mesh& mesh : {tetrahedron, triangle, with_hole}) {
        const TileInput input = make_room_for_tiles(mesh, {});
        for (const uint32_t triangles : {0u, 30u, 100u}) {
            const TileBase tiles = tiles_of(input, triangles);
            expect_sound(input, tiles, std::to_string(mesh.triangles.size()) + " to " + std::to_string(triangles));
            EXPECT_TRUE(tiles.pairing.doublets.empty()) << mesh.triangles.size();
        }
    }
}

TEST(TileBase, RoomIsMadeOnTheSameSurfaceWithTheSameCreases) {
    const Mesh cube = cleaned(corpus::box(1, 1, 1));
    const TileInput input = make_room_for_tiles(cube, find_creases(cube, 1));
    EXPECT_EQ(input.mesh.triangles.size(), 48u);
    EXPECT_EQ(std::count(input.sharp.begin(), input.sharp.end(), true), 2 * 2 * 12);
    EXPECT_EQ(find_creases(input.mesh, 1), input.sharp);
    // A boundary of three edges gets a fourth, everything else stays.
    Mesh with_hole = cleaned(corpus::sphere(6));
    with_hole.triangles.pop_back();
    const TileInput open = make_room_for_tiles(with_hole, std::vector<bool>(3 * with_hole.triangles.size(), false));
    EXPECT_EQ(open.mesh.triangles.size(), with_hole.triangles.size() + 1);
    EXPECT_EQ(open.sharp.size(), 3 * open.mesh.triangles.size());
    const Topology topology = build_topology(open.mesh);
    EXPECT_EQ(std::count(topology.twin.begin(), topology.twin.end(), kNone), 4);
}

TEST(TileBase, EachOfManyComponentsHasItsQuads) {
    const Mesh mesh = cleaned(corpus::together(
        {corpus::sphere(6), corpus::torus(24, 12, 0.7, 0.3), corpus::disk(7, 12), corpus::box(4, 1, 1)}, 3));
    const TileInput input = make_room_for_tiles(mesh, {});
    expect_sound(input, tiles_of(input, 80), "four parts");
}

}  // namespace
}  // namespace gim

#include "encoder/tiles/base_mesh.h"

#include <gtest/gtest.h>

#include <numbers>

#include "corpus/generators.h"
#include "encoder/surface/closest_point.h"
#include "encoder/surface/topology_summary.h"
#include "tests/encoder/stage_meshes.h"
#include "tests/encoder/tiles/base_undo.h"

namespace gim {
namespace {

Mesh cleaned(const TriangleMesh& mesh) { return clean(mesh, {.require_connected = false}).value().mesh; }

std::vector<bool> creases_of(const Mesh& mesh) { return find_creases(mesh, std::numbers::pi / 4); }

TEST(BaseMesh, UndoingTheListGivesTheInputBack) {
    for (const NamedMesh& m : surfaces()) {
        const BaseHierarchy hierarchy(m.mesh, creases_of(m.mesh));
        const BaseMesh base = hierarchy.cut(m.mesh, static_cast<uint32_t>(hierarchy.collapses().size()));
        EXPECT_LT(base.triangles.size(), m.mesh.triangles.size()) << m.name;
        BaseUndo undo(base, m.mesh.positions.size());
        for (size_t i = base.collapses.size(); i-- > 0;)
            ASSERT_TRUE(undo.undo(base.collapses[i])) << m.name << " " << i;
        EXPECT_EQ(normal_form(undo.triangles()), normal_form(m.mesh.triangles)) << m.name;
    }
}

TEST(BaseMesh, EveryPrefixIsASimplicialManifoldOfTheSameTopology) {
    for (const NamedMesh& m : surfaces()) {
        const BaseHierarchy hierarchy(m.mesh, creases_of(m.mesh));
        const TopologySummary input = analyse_topology(m.mesh.triangles, m.mesh.positions.size()).summary;
        const auto all = static_cast<uint32_t>(hierarchy.collapses().size());
        for (uint32_t k = 0; k <= 12; ++k) {
            // Most looks near the end, where the bases are.
            const uint32_t count = k < 6 ? all * k / 6 : all - std::min(all, (12 - k) * 7);
            const BaseMesh base = hierarchy.cut(m.mesh, count);
            const TopologySummary now = analyse_topology(base.triangles, m.mesh.positions.size()).summary;
            EXPECT_TRUE(now.manifold) << m.name << " " << count;
            EXPECT_EQ(now.euler, input.euler) << m.name << " " << count;
            EXPECT_EQ(now.components, input.components) << m.name << " " << count;
            EXPECT_EQ(now.boundary_loops, input.boundary_loops) << m.name << " " << count;
        }
    }
}

TEST(BaseMesh, ListGoesDownToAFewFaces) {
    for (const NamedMesh& m : surfaces()) {
        const BaseHierarchy hierarchy(m.mesh, {});
        const BaseMesh base = hierarchy.cut(m.mesh, static_cast<uint32_t>(hierarchy.collapses().size()));
        const TopologySummary s = analyse_topology(base.triangles, m.mesh.positions.size()).summary;
        EXPECT_LE(base.triangles.size(), 14 * s.components + 24 * m.genus + 12 * m.boundary_loops) << m.name;
    }
}

TEST(BaseMesh, CutHasTheWantedSize) {
    const Mesh mesh = cleaned(corpus::sphere(12));
    const BaseHierarchy hierarchy(mesh, {});
    for (const uint32_t faces : {12u, 40u, 100u, 500u, 1728u, 5000u}) {
        const BaseMesh base = hierarchy.cut(mesh, hierarchy.collapses_down_to(faces));
        EXPECT_EQ(base.triangles.size(), std::min<size_t>(faces, mesh.triangles.size()));
    }
    // The cube is the smallest sphere of quads without a vertex of two.
    EXPECT_EQ(hierarchy.cut(mesh, hierarchy.collapses_down_to(0)).triangles.size(), 12u);
}

TEST(BaseMesh, FacesOfASphereAllLookOutwards) {
    const Mesh mesh = cleaned(corpus::roughened(corpus::sphere(12), 0.01, 5));
    const BaseHierarchy hierarchy(mesh, {});
    for (const uint32_t faces : {16u, 40u, 200u}) {
        const BaseMesh base = hierarchy.cut(mesh, hierarchy.collapses_down_to(faces));
        for (const Triangle& t : base.triangles) {
            const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
            EXPECT_GT((b - a).cross(c - a).dot(a + b + c), 0) << faces;
        }
    }
}

TEST(BaseMesh, BoxKeepsItsTwelveCreasesAndEightCorners) {
    const Mesh mesh = cleaned(corpus::box(8, 0.6, 0.3));
    const BaseHierarchy hierarchy(mesh, creases_of(mesh));
    const BaseMesh base = hierarchy.cut(mesh, hierarchy.collapses_down_to(12));
    EXPECT_EQ(base.triangles.size(), 12u);
    EXPECT_EQ(base.creases.size(), 12u);
    EXPECT_EQ(std::count(base.kinds.begin(), base.kinds.end(), VertexKind::kCorner), 8);
    EXPECT_EQ(std::count(base.kinds.begin(), base.kinds.end(), VertexKind::kCrease), 12 * 7);
    for (const auto& edge : base.creases) {
        for (const uint32_t v : edge) EXPECT_EQ(base.kinds[v], VertexKind::kCorner);
    }
}

TEST(BaseMesh, CreaseVerticesMoveAlongTheirCreases) {
    const Mesh mesh = cleaned(corpus::plate_with_holes(2, 5));
    const std::vector<bool> sharp = creases_of(mesh);
    const BaseHierarchy hierarchy(mesh, sharp);
    const BaseMesh base = hierarchy.cut(mesh, hierarchy.with_all_creases());
    const Topology topology = build_topology(mesh);
    // On a plate a crease is a straight line, so a vertex that moves along it stays on it.
    std::vector<uint32_t> into(mesh.positions.size());
    for (uint32_t v = 0; v < into.size(); ++v) into[v] = v;
    for (size_t i = base.collapses.size(); i-- > 0;) into[base.collapses[i].vertex] = into[base.collapses[i].into];
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        if (!sharp[h]) continue;
        const Vec3 along = (mesh.positions[to(mesh, h)] - mesh.positions[from(mesh, h)]).normalized();
        const Vec3 moved = mesh.positions[into[from(mesh, h)]] - mesh.positions[from(mesh, h)];
        if (base.kinds[from(mesh, h)] == VertexKind::kCorner) {
            EXPECT_EQ(moved.norm(), 0);
        }
        EXPECT_LT(moved.cross(along).norm(), 1e-9);
    }
}

// Where creases leave no other way they end, and nothing claims to lie on them.
TEST(BaseMesh, CreasesThatAreGivenUpAreSmooth) {
    const Mesh mesh = cleaned(corpus::plate_with_holes(2, 5));
    const BaseHierarchy hierarchy(mesh, std::vector<bool>(3 * mesh.triangles.size(), true));
    const BaseMesh base = hierarchy.cut(mesh, static_cast<uint32_t>(hierarchy.collapses().size()));
    EXPECT_LT(base.triangles.size(), mesh.triangles.size() / 4);
    std::vector<std::array<uint32_t, 2>> edges;
    for (const Triangle& t : base.triangles) {
        for (uint32_t i = 0; i < 3; ++i)
            edges.push_back({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
    }
    std::sort(edges.begin(), edges.end());
    for (const auto& crease : base.creases) EXPECT_TRUE(std::binary_search(edges.begin(), edges.end(), crease));
    EXPECT_EQ(std::count(base.kinds.begin(), base.kinds.end(), VertexKind::kSmooth) > 0, true);
}

TEST(BaseMesh, BoundaryOfASquareKeepsItsCorners) {
    const Mesh mesh = cleaned(corpus::terrain(40));
    const BaseHierarchy hierarchy(mesh, {});
    const BaseMesh base = hierarchy.cut(mesh, hierarchy.collapses_down_to(60));
    std::vector<bool> kept(mesh.positions.size(), false);
    for (const Triangle& t : base.triangles) kept[t[0]] = kept[t[1]] = kept[t[2]] = true;
    Vec3 low = mesh.positions[0], high = low;
    for (const Vec3& p : mesh.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
    uint32_t corners = 0;
    for (uint32_t v = 0; v < kept.size(); ++v) {
        const Vec3& p = mesh.positions[v];
        const int at = (p[0] == low[0]) + (p[0] == high[0]) + (p[1] == low[1]) + (p[1] == high[1]);
        if (at == 2) corners += kept[v];
    }
    EXPECT_EQ(corners, 4u);
}

TEST(BaseMesh, LimbsKeepTheirTips) {
    const Mesh mesh = cleaned(corpus::limbed_blob(48));
    const BaseHierarchy hierarchy(mesh, {});
    const BaseMesh base = hierarchy.cut(mesh, hierarchy.collapses_down_to(160));
    const ClosestPointTree tree(Mesh{mesh.positions, base.triangles});
    Vec3 low = mesh.positions[0], high = low;
    for (const Vec3& p : mesh.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
    double worst = 0;
    for (const Vec3& p : mesh.positions) worst = std::max(worst, tree.find(p).squared_distance);
    EXPECT_LT(std::sqrt(worst), 0.05 * (high - low).norm());
}

TEST(BaseMesh, SameInputGivesTheSameList) {
    const Mesh mesh = cleaned(corpus::melted_tori(2, 40));
    const BaseHierarchy a(mesh, {}), b(mesh, {});
    ASSERT_EQ(a.collapses().size(), b.collapses().size());
    for (size_t i = 0; i < a.collapses().size(); ++i) EXPECT_EQ(a.collapses()[i].vertex, b.collapses()[i].vertex);
}

}  // namespace
}  // namespace gim

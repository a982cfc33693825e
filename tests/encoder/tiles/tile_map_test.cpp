#include "encoder/tiles/tile_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "encoder/surface/stretch.h"
#include "encoder/tiles/locate_samples.h"
#include "tests/encoder/tiles/mapped_meshes.h"

namespace gim {
namespace {

constexpr uint32_t kTiles = 40;

double squared_length(const TileTriangle& t, size_t i) { return (t.corners[(i + 1) % 3] - t.corners[i]).squaredNorm(); }

TEST(TileMap, IsOneToOneOnEverySurface) {
    for (const NamedMesh& m : surfaces()) {
        const MappedMesh made = mapped(m.mesh, kTiles);
        if (!made.base.pairing.unpaired.empty()) continue;  // a fault of the base
        const TileMap& map = made.map;
        ASSERT_FALSE(map.triangles.empty()) << m.name;
        double area = 0;
        for (const TileTriangle& t : map.placed) {
            const double twice = twice_signed_area(t.corners[0], t.corners[1], t.corners[2]);
            ASSERT_GT(twice, 0) << m.name;
            area += 0.5 * twice;
            const Vec2 centroid = (t.corners[0] + t.corners[1] + t.corners[2]) / 3;
            ASSERT_TRUE((centroid.array() >= 0).all() && (centroid.array() <= 1).all()) << m.name;
        }
        // Together the triangles cover the tiles exactly once.
        if (map.stray == 0) {
            EXPECT_NEAR(area, static_cast<double>(map.quads.size()), 1e-9 * area) << m.name;
        }
        // Both sides of an edge agree, although they lie in different frames.
        const Topology topology = build_topology({made.input.mesh.positions, map.triangles});
        for (uint32_t h = 0; h < topology.twin.size(); ++h) {
            if (topology.twin[h] == kNone) continue;
            ASSERT_EQ(squared_length(map.placed[h / 3], h % 3),
                      squared_length(map.placed[topology.twin[h] / 3], topology.twin[h] % 3))
                << m.name;
        }
    }
}

TEST(TileMap, KeepsTheTrianglesOfClosedSurfaces) {
    for (const NamedMesh& m : connected_meshes()) {
        if (m.boundary_loops != 0) continue;
        const MappedMesh made = mapped(m.mesh, kTiles);
        EXPECT_TRUE(made.map.left_out.empty()) << m.name;
        EXPECT_EQ(made.map.triangles, made.input.mesh.triangles) << m.name;
    }
}

TEST(TileMap, LeavesOutFewVerticesAtBoundaries) {
    for (const NamedMesh& m : surfaces()) {
        if (m.boundary_loops == 0) continue;
        const MappedMesh made = mapped(m.mesh, kTiles);
        const size_t vertices = made.input.mesh.positions.size();
        EXPECT_LE(1000 * made.map.left_out.size(), vertices) << m.name;
        EXPECT_LE(200 * made.map.stray, vertices) << m.name;
        // What is left of the boundary covers the borders of the tiles: samples there lie on it.
        EXPECT_TRUE(locate_samples(made.map, 16).ok()) << m.name;
    }
}

// Boundary vertices that are listed by a coarser mesh before its inner ones have no room at first.
TEST(TileMap, BoundariesLieOnBordersOfTiles) {
    const Mesh mesh = clean(corpus::roughened(corpus::disk(30, 90), 0.03, 1)).value().mesh;
    const MappedMesh made = mapped(mesh, 20);
    const Topology topology = build_topology(made.input.mesh);
    size_t on_boundary = 0, beside = 0;
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        if (topology.twin[h] != kNone) continue;
        const TilePlace& place = made.map.places[from(made.input.mesh, h)];
        const Vec2& uv = place.uv;
        ++on_boundary;
        beside += uv.x() != 0 && uv.x() != 1 && uv.y() != 0 && uv.y() != 1;
    }
    EXPECT_GE(on_boundary, 90u);
    EXPECT_LE(20 * beside, on_boundary);
}

TEST(TileMap, CreasesLieOnBordersOfTiles) {
    const std::vector<std::pair<std::string, TriangleMesh>> parts{
        {"cube", corpus::box(12, 1, 1)}, {"bar", corpus::box(12, 0.5, 2)}, {"plate", corpus::plate_with_holes(2, 4)}};
    for (const auto& part : parts) {
        const MappedMesh made = mapped(clean(part.second).value().mesh, 60, 1.0);
        EXPECT_TRUE(made.map.left_out.empty()) << part.first;
        const Mesh& mesh = made.input.mesh;
        size_t on_creases = 0, beside = 0;
        for (uint32_t h = 0; h < made.input.sharp.size(); ++h) {
            if (!made.input.sharp[h]) continue;
            const Vec2& uv = made.map.places[from(mesh, h)].uv;
            ++on_creases;
            beside += uv.x() != 0 && uv.x() != 1 && uv.y() != 0 && uv.y() != 1;
        }
        EXPECT_GT(on_creases, 100u) << part.first;
        EXPECT_LE(20 * beside, on_creases) << part.first;
    }
}

// Corners that stay at the base vertices give .84 and .40.
TEST(TileMap, CornersOfTilesMoveToWhereTheStretchIsLess) {
    const MappedMesh ball = mapped(clean(corpus::sphere(30)).value().mesh, kTiles);
    EXPECT_GT(stretch_efficiency(ball.input.mesh.positions, ball.map), 0.9);
    const MappedMesh limbs = mapped(clean(corpus::limbed_blob(24)).value().mesh, 2 * kTiles);
    EXPECT_GT(stretch_efficiency(limbs.input.mesh.positions, limbs.map), 0.55);
}

TEST(TileMap, CornersOfTilesAreVertices) {
    const MappedMesh made = mapped(clean(corpus::limbed_blob(24)).value().mesh, kTiles);
    for (const Quad& quad : made.map.quads) {
        for (const uint32_t v : quad) {
            const Vec2& uv = made.map.places[v].uv;
            EXPECT_TRUE((uv.x() == 0 || uv.x() == 1) && (uv.y() == 0 || uv.y() == 1));
            const Quad& there = made.map.quads[made.map.places[v].tile];
            EXPECT_NE(std::find(there.begin(), there.end(), v), there.end());
        }
    }
}

TEST(TileMap, SpreadsTheSurfaceEvenly) {
    const MappedMesh made = mapped(clean(corpus::sphere(30)).value().mesh, kTiles);
    EXPECT_GT(stretch_efficiency(made.input.mesh.positions, made.map), 0.7);
}

// The corners of tiles stay where they are, so only so much can move.
TEST(TileMap, ImportanceDrawsTilesToIt) {
    const Mesh mesh = clean(corpus::sphere(30)).value().mesh;
    const auto area_in_front = [&](double importance) {
        TileMapOptions options;
        for (const Vec3& p : mesh.positions) options.importance.push_back(p.x() > 0 ? importance : 1);
        const MappedMesh made = mapped(mesh, kTiles, 0, options);
        double area = 0;
        for (size_t f = 0; f < made.map.triangles.size(); ++f) {
            const auto& at = made.map.placed[f].corners;
            if (made.input.mesh.positions[made.map.triangles[f][0]].x() > 0)
                area += 0.5 * twice_signed_area(at[0], at[1], at[2]);
        }
        return area;
    };
    const double even = area_in_front(1);
    EXPECT_GT(area_in_front(16), 1.1 * even);
    EXPECT_LT(area_in_front(1.0 / 16), even / 1.1);
}

TEST(TileMap, IsTheSameEachTime) {
    const Mesh mesh = clean(corpus::torus(30, 15, 1, 0.4)).value().mesh;
    const MappedMesh a = mapped(mesh, kTiles), b = mapped(mesh, kTiles);
    for (size_t v = 0; v < a.map.places.size(); ++v) EXPECT_EQ(a.map.places[v].uv, b.map.places[v].uv);
}

TEST(TileMap, RefusesTilesThatAreNotOfTheBase) {
    const Mesh mesh = clean(corpus::torus(30, 15, 1, 0.4)).value().mesh;
    MappedMesh made = mapped(mesh, kTiles);
    std::vector<Quad> quads = made.base.pairing.quads;
    quads.pop_back();
    EXPECT_FALSE(map_tiles(made.input.mesh, made.base.base, quads, {}).ok());
    BaseMesh spoiled = made.base.base;
    std::swap(spoiled.collapses.back().left, spoiled.collapses.back().right);
    EXPECT_FALSE(map_tiles(made.input.mesh, spoiled, made.base.pairing.quads, {}).ok());
}

}  // namespace
}  // namespace gim

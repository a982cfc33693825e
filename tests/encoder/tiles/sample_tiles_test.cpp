#include "encoder/tiles/sample_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "encoder/code/decode_surface.h"
#include "encoder/code/file_units.h"
#include "encoder/surface/topology_summary.h"
#include "encoder/tiles/write_tiles.h"
#include "tests/encoder/tiles/made_tiles.h"
#include "tests/encoder/tiles/mapped_meshes.h"

namespace gim {
namespace {

TEST(SampleTiles, EverySampleIsOnTheSurface) {
    for (const NamedMesh& m : surfaces()) {
        const MappedMesh made = mapped(m.mesh, 40);
        if (!made.base.pairing.unpaired.empty()) continue;
        const auto points = locate_samples(made.map, 8);
        ASSERT_TRUE(points.ok()) << m.name << ": " << points.error().message;
        for (const SurfacePoint& p : points.value()) {
            ASSERT_LT(p.triangle, made.map.triangles.size());
            EXPECT_NEAR(p.barycentric[0] + p.barycentric[1] + p.barycentric[2], 1, 1e-9) << m.name;
            for (const double w : p.barycentric) EXPECT_GT(w, -1e-6) << m.name;
        }
    }
}

TEST(SampleTiles, SurfaceOfTheAtlasHasTheTopologyOfTheInput) {
    for (const NamedMesh& m : surfaces()) {
        const MappedMesh made = mapped(m.mesh, 40);
        if (!made.base.pairing.unpaired.empty()) continue;
        const auto points = locate_samples(made.map, 8);
        ASSERT_TRUE(points.ok()) << m.name;
        const TileImage tiles = sample_tiles(made.input.mesh.positions, made.map, points.value(), 3);
        const auto atlas = atlas_of(tiles);
        ASSERT_TRUE(atlas.ok()) << m.name;
        const Surface surface = surface_of(atlas.value());
        const auto summary = analyse_topology(surface.mesh.triangles, surface.mesh.positions.size()).summary;
        const auto wanted = analyse_topology(m.mesh.triangles, m.mesh.positions.size()).summary;
        EXPECT_EQ(summary.euler, wanted.euler) << m.name;
        EXPECT_EQ(summary.components, wanted.components) << m.name;
        EXPECT_EQ(summary.boundary_loops, wanted.boundary_loops) << m.name;
        EXPECT_EQ(surface.mesh.positions.size(), tiles.positions.size()) << m.name;
    }
}

TEST(SampleTiles, CornersAreBaseVerticesAndCopiesAreEqual) {
    const MappedMesh made = mapped(clean(corpus::melted_tori(2, 40)).value().mesh, 40);
    const auto points = locate_samples(made.map, 4);
    ASSERT_TRUE(points.ok());
    const TileImage tiles = sample_tiles(made.input.mesh.positions, made.map, points.value(), 2);
    const std::vector<uint32_t> vertices = number_quads(made.map.quads).vertices;
    for (size_t v = 0; v < vertices.size(); ++v) EXPECT_EQ(tiles.positions[v], made.input.mesh.positions[vertices[v]]);
    const GeometryImage atlas = atlas_of(tiles).value();
    for (const auto& copies : atlas.gluing.shared) {
        for (const uint32_t texel : copies) EXPECT_EQ(atlas.positions[texel], atlas.positions[copies.front()]);
    }
}

TEST(SampleTiles, SamplesOfACreaseLieOnIt) {
    const MappedMesh made = mapped(clean(corpus::box(12, 1, 1)).value().mesh, 24, 1.0);
    const auto points = locate_samples(made.map, 8);
    ASSERT_TRUE(points.ok());
    const TileImage tiles = sample_tiles(made.input.mesh.positions, made.map, points.value(), 3);
    // A sample with a zero weight lies on an edge; those on a crease must have one.
    size_t on_edges = 0;
    for (size_t i = tiles.vertices; i < tiles.positions.size(); ++i) {
        const Vec3 p = tiles.positions[i].cwiseAbs();
        const int faces = (p.x() > 0.5 - 1e-12) + (p.y() > 0.5 - 1e-12) + (p.z() > 0.5 - 1e-12);
        on_edges += faces >= 2;
        EXPECT_GE(faces, 1) << tiles.positions[i].transpose();
    }
    EXPECT_GT(on_edges, 12u * 7u);
}

using Corner = std::array<float, 3>;

// The triangles as places, each from its least corner on, in ascending order.
std::vector<std::array<Corner, 3>> triangle_places(const Mesh& mesh) {
    std::vector<std::array<Corner, 3>> places;
    for (const Triangle& t : mesh.triangles) {
        std::array<Corner, 3> corners;
        for (size_t i = 0; i < 3; ++i) {
            for (Eigen::Index k = 0; k < 3; ++k) corners[i][size_t(k)] = static_cast<float>(mesh.positions[t[i]][k]);
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        places.push_back(corners);
    }
    std::sort(places.begin(), places.end());
    return places;
}

TEST(SampleTiles, SurfaceOfTheAtlasIsTheOneThatIsDecoded) {
    CodingParameters lossless;
    lossless.bits = 12;
    lossless.base_side = 3;
    for (const test::MadeQuads& made : test::all_made_quads()) {
        for (const uint32_t exponent : {1u, 3u}) {
            SCOPED_TRACE(made.name + " " + std::to_string(exponent));
            TileImage image = test::tile_image(made, exponent, 0.3);
            const auto decoded = decode_surface(write_tiles(image, lossless).value(), 0);
            ASSERT_TRUE(decoded.ok());
            const Units units = tile_units(image, 12).value();
            const auto integers = to_units<int32_t>(image.positions, units);
            for (size_t i = 0; i < integers.size(); ++i)
                image.positions[i / 3][static_cast<Eigen::Index>(i % 3)] =
                    units.origin[i % 3] + units.step * static_cast<float>(integers[i]);
            const Surface atlas = surface_of(atlas_of(image).value());
            EXPECT_EQ(triangle_places(atlas.mesh), triangle_places(decoded.value()));
        }
    }
}

}  // namespace
}  // namespace gim

#include "encoder/tiles/write_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "encoder/code/decode_surface.h"
#include "encoder/code/file_units.h"
#include "format/tile_atlas.h"
#include "gim/decoder.hpp"
#include "gim/encoder.h"
#include "tests/encoder/tiles/made_tiles.h"

namespace gim {
namespace {

using namespace gim::test;

CodingParameters lossless(uint32_t bits = 12) {
    CodingParameters p;
    p.bits = bits;
    p.base_side = 3;
    return p;
}
CodingParameters lossy(double quantizer) {
    CodingParameters p = lossless();
    p.lossless = false;
    p.quantizer = quantizer;
    return p;
}

TriangleMesh decoded(const std::vector<uint8_t>& file, uint32_t level) {
    const auto mesh = decode_surface(file, level);
    EXPECT_TRUE(mesh.ok()) << (mesh.ok() ? "" : mesh.error().message);
    TriangleMesh out;
    if (!mesh.ok()) return out;
    for (const Vec3& p : mesh.value().positions) out.positions.push_back({p[0], p[1], p[2]});
    out.triangles.assign(mesh.value().triangles.begin(), mesh.value().triangles.end());
    return out;
}

TEST(WriteTiles, LosslessFilesDecodeToTheQuantizedSamples) {
    for (const MadeQuads& made : all_made_quads()) {
        for (const uint32_t exponent : {1u, 3u, 4u}) {
            SCOPED_TRACE(made.name + " " + std::to_string(exponent));
            const TileImage image = tile_image(made, exponent, 0.3);
            const auto file = write_tiles(image, lossless(10));
            ASSERT_TRUE(file.ok()) << file.error().message;
            const Units units = tile_units(image, 10).value();
            std::multiset<std::array<float, 3>> expected, got;
            const auto integers = to_units<int32_t>(image.positions, units);
            for (size_t i = 0; i < integers.size(); i += 3) {
                std::array<float, 3> p;
                for (size_t k = 0; k < 3; ++k)
                    p[k] = units.origin[k] + units.step * static_cast<float>(integers[i + k]);
                expected.insert(p);
            }
            Decoder decoder;
            ASSERT_EQ(decoder.open(file.value()), GIM_OK);
            DecoderLevel level;
            ASSERT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
            std::vector<float> positions(size_t{level.vertex_count} * 3);
            ASSERT_EQ(decoder.mesh(level, {positions, {}, {}, {}}), GIM_OK);
            for (size_t i = 0; i < positions.size(); i += 3)
                got.insert({positions[i], positions[i + 1], positions[i + 2]});
            EXPECT_EQ(expected, got);
        }
    }
}

TEST(WriteTiles, EveryLevelIsASurfaceOfTheRightKind) {
    for (const MadeQuads& made : all_made_quads()) {
        for (const CodingParameters& parameters : {lossless(), lossy(4), lossy(60)}) {
            SCOPED_TRACE(made.name);
            const TileImage image = tile_image(made, 4, 0.02);
            const auto file = write_tiles(image, parameters);
            ASSERT_TRUE(file.ok());
            const auto info = read_own_info(file.value());
            ASSERT_TRUE(info.ok());
            EXPECT_EQ(info.value().layout, static_cast<uint32_t>(GIM_LAYOUT_TILES));
            ASSERT_GE(info.value().level_count, 3u);
            for (uint32_t level = 0; level < info.value().level_count; ++level) {
                const TopologySummary topology = summarize_topology(decoded(file.value(), level));
                EXPECT_TRUE(topology.manifold) << level;
                EXPECT_EQ(topology.euler, made.euler) << level;
                EXPECT_EQ(topology.components, static_cast<uint64_t>(made.components)) << level;
                EXPECT_EQ(topology.boundary_loops, static_cast<uint64_t>(made.boundary_loops)) << level;
                EXPECT_EQ(topology.triangles, 2 * made.quads.size() << (2 * (4 - level))) << level;
            }
        }
    }
}

TEST(WriteTiles, TheSurfaceDoesNotDependOnTheOrderOfTilesAndCorners) {
    TileImage image = tile_image(cube(), 3, 0, true);
    const auto first = write_tiles(image, lossy(10)).value();
    const TriangleMesh a = decoded(first, 0);
    // Tile 2 becomes tile 0 and is turned by a quarter.
    MadeQuads other = cube();
    std::rotate(other.quads[2].begin(), other.quads[2].begin() + 1, other.quads[2].end());
    std::swap(other.quads[0], other.quads[2]);
    const TriangleMesh b = decoded(write_tiles(tile_image(other, 3, 0, true), lossy(10)).value(), 0);
    ASSERT_EQ(a.positions.size(), b.positions.size());
    const auto difference = compare(a, b, {});
    ASSERT_TRUE(difference.ok());
    EXPECT_GT(difference.value().psnr, 50);
}

TEST(WriteTiles, SmallerQuantizersGiveSmallerErrorsAndLargerFiles) {
    const TileImage image = tile_image(cube(), 5, 0, true);
    const TriangleMesh reference = decoded(write_tiles(image, lossless(16)).value(), 0);
    size_t size = 0;
    double psnr = 0;
    for (const double quantizer : {100.0, 30.0, 10.0, 3.0}) {
        const auto file = write_tiles(image, lossy(quantizer)).value();
        const auto difference = compare(reference, decoded(file, 0), {});
        ASSERT_TRUE(difference.ok());
        EXPECT_GT(file.size(), size);
        EXPECT_GT(difference.value().psnr, psnr + 3);
        size = file.size();
        psnr = difference.value().psnr;
    }
}

TEST(WriteTiles, SharpImagesHaveTheOtherWavelet) {
    TileImage image = tile_image(cube(), 4);
    image.is_sharp = true;
    image.sharp.assign(24, true);
    const TriangleMesh reference = decoded(write_tiles(image, lossless(16)).value(), 0);
    const auto file = write_tiles(image, lossy(10));
    ASSERT_TRUE(file.ok());
    const auto difference = compare(reference, decoded(file.value(), 0), {});
    ASSERT_TRUE(difference.ok());
    EXPECT_GT(difference.value().psnr, 55);
}

TEST(WriteTiles, GridRepeatsBordersWithEqualBits) {
    const MadeQuads made = torus(5, 3);
    const TileImage image = tile_image(made, 3, 0.1);
    const auto file = write_tiles(image, lossy(20)).value();
    Decoder decoder;
    ASSERT_EQ(decoder.open(file), GIM_OK);
    for (uint32_t l = 0; l < decoder.info().level_count; ++l) {
        DecoderLevel level;
        ASSERT_EQ(decoder.read_level(0, l, &level), GIM_OK);
        const size_t count = size_t{level.width} * level.height;
        std::vector<float> grid(3 * count), grid_normals(3 * count), uv(2 * count), positions(3 * level.vertex_count),
            normals(3 * level.vertex_count), mesh_uv(2 * level.vertex_count);
        std::vector<uint32_t> of_grid(3 * level.triangle_count), of_mesh(3 * level.triangle_count);
        ASSERT_EQ(decoder.grid(level, {grid, grid_normals, uv, of_grid}), GIM_OK);
        ASSERT_EQ(decoder.mesh(level, {positions, normals, mesh_uv, of_mesh}), GIM_OK);
        for (size_t i = 0; i < of_grid.size(); ++i) {
            for (size_t k = 0; k < 3; ++k) {
                ASSERT_EQ(grid[3 * of_grid[i] + k], positions[3 * of_mesh[i] + k]);
                ASSERT_EQ(grid_normals[3 * of_grid[i] + k], normals[3 * of_mesh[i] + k]);
            }
        }
        for (size_t i = 0; i < uv.size(); ++i) ASSERT_TRUE(uv[i] >= 0 && uv[i] <= 1);
        if (l == 0) {
            for (uint32_t row = 0; row < level.height; ++row) {
                for (uint32_t column = 0; column < level.width; ++column) {
                    const size_t i = size_t{row} * level.width + column;
                    if (std::isnan(grid[3 * i])) continue;
                    ASSERT_EQ(uv[2 * i], static_cast<float>(column) / static_cast<float>(level.width - 1));
                    ASSERT_EQ(uv[2 * i + 1], static_cast<float>(row) / static_cast<float>(level.height - 1));
                }
            }
        }
    }
}

TEST(WriteTiles, NormalsPointOutwards) {
    const TileImage image = tile_image(cube(), 3, 0, true);
    const auto file = write_tiles(image, lossless(16)).value();
    Decoder decoder;
    ASSERT_EQ(decoder.open(file), GIM_OK);
    DecoderLevel level;
    ASSERT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
    std::vector<float> positions(3 * level.vertex_count), normals(3 * level.vertex_count);
    ASSERT_EQ(decoder.mesh(level, {positions, normals, {}, {}}), GIM_OK);
    for (size_t i = 0; i < positions.size(); i += 3) {
        const double dot =
            positions[i] * normals[i] + positions[i + 1] * normals[i + 1] + positions[i + 2] * normals[i + 2];
        EXPECT_GT(dot, 0.8);
    }
}

TEST(WriteTiles, WrongComplexesAreRefused) {
    const auto refused = [](std::vector<Quad> quads, uint32_t vertices, const char* word) {
        TileImage image;
        image.quads = std::move(quads);
        image.vertices = vertices;
        image.exponent = 1;
        const auto file = write_tiles(image, lossless());
        ASSERT_FALSE(file.ok());
        EXPECT_NE(file.error().message.find(word), std::string::npos) << file.error().message;
    };
    refused({}, 0, "no tile");
    refused({{0, 1, 2, 4}}, 4, "no vertex");
    refused({{0, 1, 2, 1}}, 3, "two corners");
    refused({{0, 1, 2, 3}, {1, 0, 4, 5}, {1, 0, 6, 7}}, 8, "same direction");
    refused({{0, 1, 2, 3}, {0, 1, 4, 5}}, 6, "same direction");
    refused({{0, 1, 2, 3}}, 5, "no tile");
    refused({{0, 1, 2, 3}, {0, 4, 5, 6}}, 7, "one fan");
    refused({{0, 1, 2, 3}}, 4, "positions");
}

}  // namespace
}  // namespace gim

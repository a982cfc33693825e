#include "tools/input.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/tools/test_files.h"

namespace gim {
namespace {

using test::TemporaryFolder;

Bytes raw_bytes(uint32_t side) {
    std::vector<float> planes;
    for (uint32_t k = 0; k < 3; ++k) {
        for (uint32_t i = 0; i < side * side; ++i) {
            planes.push_back(static_cast<float>(k == 0 ? i % side : k == 1 ? i / side : 0));
        }
    }
    Bytes bytes(planes.size() * sizeof(float));
    std::memcpy(bytes.data(), planes.data(), bytes.size());
    return bytes;
}

TEST(Input, RawImagesAreKnownByTheirSize) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_file(folder.file("raw.gim"), raw_bytes(9)).ok());
    const Result<Input> input = read_input(folder.file("raw.gim"));
    ASSERT_TRUE(input.ok()) << input.error().message;
    ASSERT_EQ(input.value().kind, Input::Kind::kRawImage);
    EXPECT_EQ(input.value().raw.side, 9U);
    EXPECT_DOUBLE_EQ(diagonal_of(input.value().raw), std::sqrt(128.0));

    const TriangleMesh mesh = to_mesh(input.value().raw);
    EXPECT_EQ(mesh.positions.size(), 81U);
    EXPECT_EQ(mesh.positions[10], (std::array<double, 3>{1, 1, 0}));
    const TopologySummary topology = summarize_topology(mesh);
    EXPECT_TRUE(topology.manifold);
    EXPECT_EQ(topology.triangles, 128U);
    EXPECT_EQ(topology.boundary_loops, 1U);
}

TEST(Input, GimFilesOfOddSizesAreRefused) {
    for (const size_t size : {size_t{1}, size_t{11}, size_t{13}, size_t{12 * 81 + 1}, size_t{12 * 82}}) {
        const Result<RawImage> raw = read_raw_image(Bytes(size, 0));
        ASSERT_FALSE(raw.ok()) << size;
        EXPECT_NE(raw.error().message.find("neither a .gim file"), std::string::npos);
    }
}

TEST(Input, MeshesNamedGimAreStillMeshes) {
    const TemporaryFolder folder;
    test::save(folder.file("mesh.gim"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const Result<Input> input = read_input(folder.file("mesh.gim"));
    ASSERT_TRUE(input.ok()) << input.error().message;
    EXPECT_EQ(input.value().kind, Input::Kind::kMesh);
}

TEST(Input, SurfacesOfFormatsThatCannotShareVerticesAreWelded) {
    const TemporaryFolder folder;
    test::save(
        folder.file("a.stl"),
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
        "facet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n");
    const Result<TriangleMesh> mesh = read_surface(folder.file("a.stl"), 0);
    ASSERT_TRUE(mesh.ok());
    EXPECT_EQ(mesh.value().positions.size(), 4U);
}

}  // namespace
}  // namespace gim

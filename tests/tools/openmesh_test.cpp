// OpenMesh, other people's software, reads what gim writes. Its half-edges accept only manifolds.
#include <gtest/gtest.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <set>

#include "tests/tools/test_files.h"
#include "tools/surface_write.h"

namespace gim {
namespace {

using Halfedges = OpenMesh::TriMesh_ArrayKernelT<>;
using test::save;
using test::TemporaryFolder;
using test::torus_image;

uint64_t boundary_edges(const Halfedges& mesh) {
    uint64_t count = 0;
    for (const auto edge : mesh.edges()) count += mesh.is_boundary(edge) ? 1 : 0;
    return count;
}

using Corner = std::array<float, 3>;

std::multiset<std::array<Corner, 3>> triangles_of(const Halfedges& mesh) {
    std::multiset<std::array<Corner, 3>> all;
    for (const auto face : mesh.faces()) {
        std::array<Corner, 3> corners;
        size_t k = 0;
        for (const auto vertex : mesh.fv_range(face)) {
            const auto p = mesh.point(vertex);
            corners[k++] = {p[0], p[1], p[2]};
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        all.insert(corners);
    }
    return all;
}

std::multiset<std::array<Corner, 3>> triangles_of(const TriangleMesh& mesh) {
    std::multiset<std::array<Corner, 3>> all;
    for (const auto& t : mesh.triangles) {
        std::array<Corner, 3> corners;
        for (size_t k = 0; k < 3; ++k) {
            for (size_t i = 0; i < 3; ++i) corners[k][i] = static_cast<float>(mesh.positions[t[k]][i]);
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        all.insert(corners);
    }
    return all;
}

class OpenMeshReads : public ::testing::TestWithParam<const char*> {};

TEST_P(OpenMeshReads, OurFilesAsTheSameClosedSurfaces) {
    const std::string extension = GetParam();
    const std::vector<DecodedImage> images = {torus_image(9), torus_image(5, 10)};
    const Result<Bytes> bytes = write_surface(*surface_format_of(extension), images);
    ASSERT_TRUE(bytes.ok());
    const TemporaryFolder folder;
    const std::string path = folder.file("two-tori." + extension);
    save(path, {reinterpret_cast<const char*>(bytes.value().data()), bytes.value().size()});

    Halfedges mesh;
    ASSERT_TRUE(OpenMesh::IO::read_mesh(mesh, path));
    const TriangleMesh expected = to_mesh(images);
    EXPECT_EQ(mesh.n_vertices(), expected.positions.size());
    EXPECT_EQ(mesh.n_faces(), expected.triangles.size());
    EXPECT_EQ(boundary_edges(mesh), 0u);
    EXPECT_EQ(mesh.n_vertices() + mesh.n_faces(), mesh.n_edges());  // Euler characteristic 0, as of two tori
    EXPECT_TRUE(triangles_of(mesh) == triangles_of(expected));
}

INSTANTIATE_TEST_SUITE_P(Formats, OpenMeshReads, ::testing::Values("ply", "obj", "off", "stl"),
                         [](const auto& format) { return std::string(format.param); });

}  // namespace
}  // namespace gim

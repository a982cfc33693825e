#include "encoder/surface/refine.h"

#include <gtest/gtest.h>

#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

TEST(RefineLargeFaces, LeavesNoLargeFaceAndTheSameSurface) {
    for (const NamedMesh& m : connected_meshes()) {
        const double area = surface_area(m.mesh), largest = area / 3000;
        const Mesh refined = refine_large_faces(m.mesh, largest);
        for (uint32_t f = 0; f < refined.triangles.size(); ++f) EXPECT_LE(face_area(refined, f), largest) << m.name;
        EXPECT_NEAR(surface_area(refined), area, 1e-9 * area) << m.name;
        EXPECT_EQ(euler_characteristic(refined), euler_characteristic(m.mesh)) << m.name;
        for (size_t v = 0; v < m.mesh.positions.size(); ++v)
            EXPECT_EQ(refined.positions[v], m.mesh.positions[v]) << m.name;
    }
}

TEST(RefineLargeFaces, SmallFacesStayAsTheyAre) {
    const Mesh mesh = clean(corpus::sphere(10)).value().mesh;
    EXPECT_EQ(refine_large_faces(mesh, 1e9).triangles, mesh.triangles);
}

}  // namespace
}  // namespace gim

#include "encoder/charts/even_axes.h"

#include <gtest/gtest.h>

#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

Mesh stretched_sphere(const Vec3& factors) {
    for (NamedMesh& m : surfaces()) {
        if (m.name != "sphere-1728") continue;
        const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
        map_positions(turn * factors.asDiagonal(), m.mesh.positions);
        return std::move(m.mesh);
    }
    ADD_FAILURE() << "the corpus has no sphere";
    return {};
}

TEST(EvenAxes, ALongSurfaceGetsEqualExtents) {
    Mesh mesh = stretched_sphere({1, 2, 50});
    const EvenAxes axes = even_axes(mesh);
    EXPECT_GT(axes.eccentricity, 20);
    EXPECT_GT(axes.into.determinant(), 0);
    EXPECT_LT((axes.into * axes.back - Eigen::Matrix3d::Identity()).norm(), 1e-9);
    map_positions(axes.into, mesh.positions);
    EXPECT_LT(even_axes(mesh).eccentricity, 2.5);  // the map changes where the area lies
}

TEST(EvenAxes, ASurfaceInAPlaneStaysInIt) {
    const EvenAxes axes = even_axes(stretched_sphere({3, 1, 0}));
    EXPECT_LT(axes.eccentricity, 10);
    EXPECT_NEAR(axes.into.determinant(), axes.eccentricity, 1e-6);
}

TEST(EvenAxes, ARoundSurfaceStays) { EXPECT_LT(even_axes(stretched_sphere({1, 1, 1})).eccentricity, 1.2); }

}  // namespace
}  // namespace gim

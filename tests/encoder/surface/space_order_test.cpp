#include "encoder/surface/space_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "corpus/generators.h"

namespace gim {
namespace {

Mesh shuffled_sphere() {
    const TriangleMesh sphere = corpus::sphere(24);
    Mesh mesh;
    for (const auto& p : sphere.positions) mesh.positions.emplace_back(p[0], p[1], p[2]);
    const size_t count = sphere.triangles.size();
    constexpr size_t kStride = 7919;  // a prime that does not divide the count, so all triangles come
    for (size_t i = 0; i < count; ++i) mesh.triangles.push_back(sphere.triangles[i * kStride % count]);
    return mesh;
}

double length_of_walk(const Mesh& mesh) {
    double length = 0;
    for (size_t f = 1; f < mesh.triangles.size(); ++f)
        length += (mesh.positions[mesh.triangles[f][0]] - mesh.positions[mesh.triangles[f - 1][0]]).norm();
    return length;
}

TEST(SpaceOrder, KeepsAllTrianglesAndTheirCorners) {
    const Mesh before = shuffled_sphere(), after = in_space_order(before);
    EXPECT_EQ(after.positions.size(), before.positions.size());
    std::vector<Triangle> a = before.triangles, b = after.triangles;
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    EXPECT_EQ(a, b);
    EXPECT_EQ(std::adjacent_find(a.begin(), a.end()), a.end());
}

TEST(SpaceOrder, NeighboursInTheListAreNeighboursInSpace) {
    const Mesh mesh = shuffled_sphere();
    EXPECT_LT(length_of_walk(in_space_order(mesh)), 0.15 * length_of_walk(mesh));
}

TEST(SpaceOrder, MeshesWithoutExtentStayAsTheyAre) {
    EXPECT_TRUE(in_space_order(Mesh{}).triangles.empty());
    const Mesh point{{Vec3::Ones()}, {{0, 0, 0}, {0, 0, 0}}};
    EXPECT_EQ(in_space_order(point).triangles, point.triangles);
}

}  // namespace
}  // namespace gim

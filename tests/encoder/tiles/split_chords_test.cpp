#include "encoder/tiles/split_chords.h"

#include <gtest/gtest.h>

#include "encoder/surface/refine.h"
#include "encoder/tiles/base_mesh.h"
#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

// Returns how many edges join two vertices of features without being features.
size_t chords(const Mesh& mesh, const std::vector<bool>& sharp) {
    const Topology topology = build_topology(mesh);
    const auto feature = [&](uint32_t h) {
        const uint32_t twin = topology.twin[h];
        return twin == kNone || (!sharp.empty() && (sharp[h] || sharp[twin]));
    };
    std::vector<bool> on_feature(mesh.positions.size(), false);
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        if (feature(h)) on_feature[from(mesh, h)] = on_feature[to(mesh, h)] = true;
    }
    size_t count = 0;
    for (uint32_t h = 0; h < topology.twin.size(); ++h)
        count += !feature(h) && on_feature[from(mesh, h)] && on_feature[to(mesh, h)];
    return count / 2;
}

TEST(SplitChords, LeavesNoneAndKeepsTheSurface) {
    for (const NamedMesh& m : surfaces()) {
        Mesh mesh = m.mesh;
        std::vector<bool> sharp = find_creases(mesh, 0.8);
        const auto count = static_cast<size_t>(std::count(sharp.begin(), sharp.end(), true));
        split_chords(mesh, sharp);
        EXPECT_EQ(chords(mesh, sharp), 0u) << m.name;
        EXPECT_EQ(static_cast<size_t>(std::count(sharp.begin(), sharp.end(), true)), count) << m.name;
        EXPECT_EQ(euler_characteristic(mesh), euler_characteristic(m.mesh)) << m.name;
        EXPECT_NEAR(surface_area(mesh), surface_area(m.mesh), 1e-9 * surface_area(mesh)) << m.name;
    }
}

TEST(SplitChords, SplitsTheDiagonalOfASquare) {
    Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    std::vector<bool> sharp;
    split_chords(mesh, sharp);
    ASSERT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.positions[4], Vec3(0.5, 0.5, 0));
    EXPECT_EQ(mesh.triangles.size(), 4u);
    EXPECT_TRUE(sharp.empty());
}

}  // namespace
}  // namespace gim

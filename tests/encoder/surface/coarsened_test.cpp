#include "encoder/surface/coarsened.h"

#include <gtest/gtest.h>

#include "corpus/generators.h"
#include "encoder/surface/compare_meshes.h"
#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

Mesh cleaned(const TriangleMesh& mesh) { return clean(mesh).value().mesh; }

TEST(Coarsened, DenseSurfacesLoseVerticesAndKeepTheirTopology) {
    for (const corpus::CorpusEntry& m : corpus::corpus().connected()) {
        const Mesh dense = cleaned(corpus::densified(m.mesh(), 3));
        const double samples = double(dense.positions.size());
        const Mesh coarse = coarsened_to(dense, 0.4 * samples);
        EXPECT_LT(double(coarse.positions.size()), 0.6 * samples) << m.name;
        EXPECT_GE(double(coarse.positions.size()), 0.35 * samples) << m.name;
        EXPECT_EQ(euler_characteristic(coarse), euler_characteristic(dense)) << m.name;
    }
}

TEST(Coarsened, OthersStayAsTheyAre) {
    const Mesh mesh = cleaned(corpus::torus(30, 20, 0.7, 0.3));
    const Mesh same = coarsened_to(mesh, 600);
    EXPECT_EQ(same.positions, mesh.positions);
    EXPECT_EQ(same.triangles, mesh.triangles);
}

TEST(Coarsened, ItStaysNear) {
    const Mesh dense = cleaned(corpus::torus(240, 120, 0.7, 0.3));
    const Mesh coarse = coarsened_to(dense, 4000);
    const auto compared = ReferenceSurface(dense).compare(coarse, {.samples = 20000});
    ASSERT_TRUE(compared.ok());
    EXPECT_GT(compared.value().psnr, 60);
}

}  // namespace
}  // namespace gim

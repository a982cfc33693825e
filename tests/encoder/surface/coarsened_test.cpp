#include "encoder/surface/coarsened.h"

#include <gtest/gtest.h>

#include "corpus/generators.h"
#include "encoder/surface/compare_meshes.h"
#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

Mesh cleaned(const TriangleMesh& mesh) { return clean(mesh).value().mesh; }

TEST(Coarsened, DenseSurfacesGetAFewVerticesPerSampleAndKeepTheirTopology) {
    for (const corpus::CorpusEntry& m : corpus::corpus().connected()) {
        const Mesh dense = cleaned(corpus::densified(m.mesh(), 3));
        const double samples = double(dense.positions.size());
        const Mesh coarse = coarsened_for(dense, samples);
        EXPECT_LT(double(coarse.positions.size()), 0.6 * samples) << m.name;
        EXPECT_GE(double(coarse.positions.size()), 0.35 * samples) << m.name;
        EXPECT_EQ(euler_characteristic(coarse), euler_characteristic(dense)) << m.name;
    }
}

TEST(Coarsened, OthersStayAsTheyAre) {
    const Mesh mesh = cleaned(corpus::torus(30, 20, 0.7, 0.3));
    const Mesh same = coarsened_for(mesh, 600 / 0.4);
    EXPECT_EQ(same.positions, mesh.positions);
    EXPECT_EQ(same.triangles, mesh.triangles);
}

TEST(Coarsened, ItStaysNear) {
    const Mesh dense = cleaned(corpus::torus(240, 120, 0.7, 0.3));
    const Mesh coarse = coarsened_for(dense, 10000);
    const auto compared = ReferenceSurface(dense).compare(coarse, {.samples = 20000});
    ASSERT_TRUE(compared.ok());
    EXPECT_GT(compared.value().psnr, 60);
}

}  // namespace
}  // namespace gim

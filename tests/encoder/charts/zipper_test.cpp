#include "encoder/charts/zipper.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/encoder/charts/packed_charts.h"
#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 edge = b - a;
    const double t = edge.squaredNorm() > 0 ? std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0) : 0;
    return (p - a - t * edge).norm();
}

TEST(Zipper, BorderSamplesLieOnTheCutPathsAndOthersStay) {
    for (const NamedMesh& m : surfaces()) {
        // Now and then the seams of a packing do not close. Then we pack again, as make_multi_chart_image() does.
        constexpr uint64_t kMostPackings = 4;
        PackedCharts s = packed_charts(m.mesh, 6, 8000);
        auto zipped = zip(s.image, s.atlas.charts, s.atlas.maps, s.packing);
        for (uint64_t seed = 2; !zipped.ok() && seed <= kMostPackings; ++seed) {
            s = packed_charts(m.mesh, 6, 8000, seed);
            zipped = zip(s.image, s.atlas.charts, s.atlas.maps, s.packing);
        }
        ASSERT_TRUE(s.packing.broken.empty()) << m.name;
        ASSERT_TRUE(zipped.ok()) << m.name << ": " << zipped.error().message;
        const MultiChartImage& image = zipped.value();
        const auto point = glue_samples(image.mask, image.seams);
        ASSERT_TRUE(point.ok()) << m.name << ": " << point.error().message;
        std::vector<uint8_t> on_border(image.positions.size(), 0);
        for (const auto& loop : trace_borders(image.mask)) {
            for (const uint32_t i : loop) {
                on_border[i] = 1;
                double nearest = 1e300;
                for (const Chart& chart : s.atlas.charts) {
                    for (size_t k = 0; k < chart.loop.size(); ++k) {
                        nearest = std::min(nearest, distance_to_segment(
                                                        image.positions[i], chart.mesh.positions[chart.loop[k]],
                                                        chart.mesh.positions[chart.loop[(k + 1) % chart.loop.size()]]));
                    }
                }
                ASSERT_LT(nearest, 1e-6) << m.name;
            }
        }
        for (size_t i = 0; i < image.positions.size(); ++i) {
            if (!on_border[i] && image.mask.defined[i]) {
                ASSERT_EQ(image.positions[i], s.image.positions[i]) << m.name;
            }
        }
    }
}

TEST(Zipper, UnzippedImageIsNotGlued) {
    const std::vector<NamedMesh> all = surfaces();
    const PackedCharts s = packed_charts(all[0].mesh, 6, 8000);
    EXPECT_FALSE(glue_samples(s.image.mask, s.image.seams).ok());
}

}  // namespace
}  // namespace gim

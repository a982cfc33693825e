#include "encoder/charts/chart_sample.h"

#include <gtest/gtest.h>

#include "encoder/surface/closest_point.h"
#include "encoder/surface/refine.h"
#include "tests/encoder/charts/packed_charts.h"
#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

TEST(ChartSample, EveryDefinedSampleLiesOnTheSurface) {
    for (const NamedMesh& m : surfaces()) {
        const PackedCharts p = packed_charts(m.mesh, 6, 8000);
        ASSERT_TRUE(p.packing.broken.empty()) << m.name;
        const MultiChartImage& image = p.image;
        EXPECT_EQ(image.mask.count(), p.packing.defined) << m.name;
        const ClosestPointTree tree(m.mesh);
        const double size = std::sqrt(surface_area(m.mesh));
        for (size_t i = 0; i < image.positions.size(); ++i) {
            if (!image.mask.defined[i]) {
                ASSERT_EQ(image.positions[i], Vec3::Zero());
                continue;
            }
            ASSERT_LT((tree.find(image.positions[i]).point - image.positions[i]).norm(), 1e-6 * size) << m.name;
        }
    }
}

TEST(ChartSample, NeighboursInTheImageAreNeighboursOnTheSurface) {
    for (const NamedMesh& m : surfaces()) {
        const PackedCharts p = packed_charts(m.mesh, 6, 8000);
        const MultiChartImage& image = p.image;
        // The map has bounded stretch. The mean leaves room for a few worse places.
        double sum = 0;
        size_t count = 0;
        for (uint32_t row = 0; row < image.height(); ++row) {
            for (uint32_t column = 0; column + 1 < image.width(); ++column) {
                if (!image.mask.at(column, row) || !image.mask.at(column + 1, row)) continue;
                const size_t i = size_t{row} * image.width() + column;
                sum += (image.positions[i + 1] - image.positions[i]).norm();
                ++count;
            }
        }
        EXPECT_LT(sum / static_cast<double>(count), 1.2 / p.packing.scale) << m.name;
        EXPECT_GT(sum / static_cast<double>(count), 0.7 / p.packing.scale) << m.name;
    }
}

}  // namespace
}  // namespace gim

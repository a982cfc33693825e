#include "encoder/charts/chart_ramps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "encoder/charts/close_chart_seams.h"
#include "tests/encoder/charts/corpus_charts.h"
#include "tests/format/random_sideband.h"

namespace gim {
namespace {

ChartLevels charts_of(const char* name) { return test::corpus_charts(name, 3000); }

// Random triples where samples are defined, else 0.
std::vector<float> noise(const ChartLevels& charts, uint64_t seed) {
    test::Random random(seed);
    std::vector<float> image(3 * charts.sample_count(), 0.0f);
    for (size_t i = 0; i < image.size(); ++i) {
        const float value = static_cast<float>(2 * random.unit() - 1);
        if (charts.image.gluing.is_defined(static_cast<uint32_t>(i / 3))) image[i] = value;
    }
    return image;
}

double dot(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += double{a[i]} * double{b[i]};
    return sum;
}

// Closed surfaces, and one with a boundary, whose samples are not corrected.
TEST(ChartRamps, TransposedIsTheAdjointOfClosing) {
    for (const char* name : {"torus-576", "disk-180"}) {
        const ChartLevels charts = charts_of(name);
        const ChartRamps ramps(charts);
        for (uint64_t seed = 1; seed < 5; ++seed) {
            const std::vector<float> x = noise(charts, seed), y = noise(charts, seed + 50);
            std::vector<float> closed = x, transposed = y;
            close_chart_seams(charts, closed);
            ramps.transpose(transposed);
            const double length = std::sqrt(dot(closed, closed) * dot(y, y));
            EXPECT_NEAR(dot(closed, y), dot(x, transposed), 1e-5 * length) << name;
            EXPECT_GT(std::abs(dot(closed, closed) - dot(x, x)), 1e-3 * dot(x, x)) << "closing does something";
        }
    }
}

}  // namespace
}  // namespace gim

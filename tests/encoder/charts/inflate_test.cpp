#include "encoder/charts/inflate.h"

#include <gtest/gtest.h>

#include "corpus/generators.h"
#include "encoder/charts/border_barrier.h"
#include "encoder/surface/clean.h"
#include "encoder/surface/stretch.h"
#include "tests/encoder/charts/packed_charts.h"

namespace gim {
namespace {

const PackedCharts& packed() {
    static const PackedCharts charts = packed_charts(clean(corpus::limbed_blob(32)).value().mesh, 12, 12000);
    return charts;
}

struct Inflated {
    std::vector<ChartMap> maps = packed().atlas.maps;
    Packing packing = packed().packing;
    explicit Inflated(const InflateOptions& options = {}) {
        inflate(packed().atlas.charts, {}, options, maps, packing);
    }
};

TEST(Inflate, ChartsGainMoreInSamplesThanTheyLoseInStretch) {
    const PackedCharts& before = packed();
    const Inflated after;
    const double was = before.packing.efficiency() * stretch_efficiency(before.atlas.charts, before.atlas.maps);
    EXPECT_GT(after.packing.efficiency() * stretch_efficiency(before.atlas.charts, after.maps), 1.05 * was);
}

TEST(Inflate, MasksAreDisksThatKeepApart) {
    const Inflated after;
    const Packing& packing = after.packing;
    EXPECT_EQ(packing.width, packed().packing.width);
    EXPECT_EQ(packing.height, packed().packing.height);
    std::vector<uint32_t> owner(size_t{packing.width} * packing.height, kNone);
    uint64_t defined = 0;
    for (uint32_t c = 0; c < packing.charts.size(); ++c) {
        const PlacedChart& placed = packing.charts[c];
        const SampleMask& mask = placed.chart.mask;
        EXPECT_TRUE(placed.chart.is_disk);
        EXPECT_TRUE(mask_is_disk(mask));
        ASSERT_LE(placed.column + mask.width, packing.width);
        ASSERT_LE(placed.row + mask.height, packing.height);
        for (uint32_t i = 0; i < mask.defined.size(); ++i) {
            if (!mask.defined[i]) continue;
            ++defined;
            uint32_t& sample =
                owner[size_t{placed.row + i / mask.width} * packing.width + placed.column + i % mask.width];
            EXPECT_EQ(sample, kNone);
            sample = c;
        }
    }
    EXPECT_EQ(defined, packing.defined);
    for (size_t i = 0; i < owner.size(); ++i) {
        if (owner[i] == kNone) continue;
        if ((i + 1) % packing.width != 0 && owner[i + 1] != kNone) {
            EXPECT_EQ(owner[i], owner[i + 1]);
        }
        if (i + packing.width < owner.size() && owner[i + packing.width] != kNone) {
            EXPECT_EQ(owner[i], owner[i + packing.width]);
        }
    }
}

TEST(Inflate, MapsStayUprightAndSimpleAndUnderTheirMasks) {
    const Inflated after;
    const std::vector<Chart>& charts = packed().atlas.charts;
    for (size_t c = 0; c < charts.size(); ++c) {
        const std::vector<Vec2>& uv = after.maps[c].uv;
        for (const Triangle& t : charts[c].mesh.triangles)
            EXPECT_GT(twice_signed_area(uv[t[0]], uv[t[1]], uv[t[2]]), 0);
        std::vector<Vec2> border;
        for (const uint32_t v : charts[c].loop) border.push_back(uv[v]);
        EXPECT_FALSE(find_crossing(border));
        // The mask covers the map within a sample and a half, because tips may be cut.
        const PlacedChart& placed = after.packing.charts[c];
        for (const Vec2& p : border) {
            const Vec2 q = placed.chart.pose(p) - Vec2(placed.column, placed.row);
            const auto x = static_cast<int64_t>(std::floor(q.x())), y = static_cast<int64_t>(std::floor(q.y()));
            bool near = false;
            for (int64_t j = y - 1; j <= y + 2; ++j) {
                for (int64_t i = x - 1; i <= x + 2; ++i) near |= placed.chart.mask.at(i, j);
            }
            EXPECT_TRUE(near);
        }
    }
}

TEST(Inflate, SameResultAtAnyThreadCount) {
    const Inflated one({.threads = 1}), many({.threads = 3});
    for (size_t c = 0; c < one.maps.size(); ++c) {
        EXPECT_EQ(one.maps[c].uv, many.maps[c].uv);
        EXPECT_EQ(one.packing.charts[c].chart.mask.defined, many.packing.charts[c].chart.mask.defined);
    }
}

}  // namespace
}  // namespace gim

#include "encoder/charts/chart_sample.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "encoder/base/parallel.h"
#include "encoder/charts/glue_charts.h"
#include "encoder/surface/stretch.h"

namespace gim {

namespace {

// Barycentric coordinates may go down to this. Otherwise rounding could leave a sample on an edge without a face.
constexpr double kRounding = -1e-9;

void sample_chart(const Chart& chart, const ChartMap& map, const PlacedChart& placed, MultiChartImage& image) {
    const SampleMask& mask = placed.chart.mask;
    std::vector<Vec2> uv;  // in the mask's own samples
    uv.reserve(map.uv.size());
    for (const Vec2& p : map.uv) uv.push_back(placed.chart.pose(p) - Vec2(placed.column, placed.row));
    constexpr double kOutside = -1;
    std::vector<double> best(mask.defined.size(), kOutside);  // least barycentric coordinate in the best face so far
    const auto position = [&](size_t i) -> Vec3& {
        return image.positions[(placed.row + i / mask.width) * image.width() + placed.column + i % mask.width];
    };
    for (const Triangle& t : chart.mesh.triangles) {
        const Vec2 &a = uv[t[0]], &b = uv[t[1]], &c = uv[t[2]];
        const double area = twice_signed_area(a, b, c);
        if (!(area > 0)) continue;
        const Vec2 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
        const double last_column = std::min(mask.width - 1.0, std::floor(high.x() + 1e-9));
        const double last_row = std::min(mask.height - 1.0, std::floor(high.y() + 1e-9));
        for (double row = std::max(0.0, std::ceil(low.y() - 1e-9)); row <= last_row; ++row) {
            for (double column = std::max(0.0, std::ceil(low.x() - 1e-9)); column <= last_column; ++column) {
                const Vec2 p(column, row);
                const std::array<double, 3> w{twice_signed_area(p, b, c) / area, twice_signed_area(a, p, c) / area,
                                              twice_signed_area(a, b, p) / area};
                const double least = std::min({w[0], w[1], w[2]});
                const size_t i = static_cast<size_t>(row) * mask.width + static_cast<size_t>(column);
                if (least < kRounding || least <= best[i] || !mask.defined[i]) continue;
                best[i] = least;
                position(i) = w[0] * chart.mesh.positions[t[0]] + w[1] * chart.mesh.positions[t[1]] +
                              w[2] * chart.mesh.positions[t[2]];
            }
        }
    }
    for (size_t i = 0; i < best.size(); ++i) {
        if (best[i] > kOutside || !mask.defined[i]) continue;
        const size_t row = i / mask.width, column = i % mask.width;
        const Vec2 p(static_cast<double>(column), static_cast<double>(row));
        double nearest = std::numeric_limits<double>::infinity();
        for (size_t k = 0; k < chart.loop.size(); ++k) {
            const uint32_t v = chart.loop[k], w = chart.loop[(k + 1) % chart.loop.size()];
            const Vec2 edge = uv[w] - uv[v];
            const double length2 = edge.squaredNorm();
            const double t = length2 > 0 ? std::clamp((p - uv[v]).dot(edge) / length2, 0.0, 1.0) : 0;
            const double distance = (p - uv[v] - t * edge).squaredNorm();
            if (distance >= nearest) continue;
            nearest = distance;
            position(i) = (1 - t) * chart.mesh.positions[v] + t * chart.mesh.positions[w];
        }
    }
}

}  // namespace

MultiChartImage sample_charts(const std::vector<Chart>& charts, const std::vector<ChartMap>& maps,
                              const Packing& packing, uint32_t threads) {
    MultiChartImage image;
    image.mask = {packing.width, packing.height, std::vector<uint8_t>(size_t{packing.width} * packing.height, 0)};
    image.positions.assign(image.mask.defined.size(), Vec3::Zero());
    for (const PlacedChart& placed : packing.charts) {
        const SampleMask& mask = placed.chart.mask;
        for (uint32_t row = 0; row < mask.height; ++row) {
            for (uint32_t column = 0; column < mask.width; ++column) {
                if (mask.at(column, row))
                    image.mask.defined[(size_t{placed.row} + row) * packing.width + placed.column + column] = 1;
            }
        }
    }
    image.gluing = glue_nothing(image.mask);
    parallel_blocks(charts.size(), 1, threads, [&](size_t, size_t begin, size_t end) {
        for (size_t c = begin; c < end; ++c) sample_chart(charts[c], maps[c], packing.charts[c], image);
    });
    return image;
}

}  // namespace gim

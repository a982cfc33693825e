// Packed and sampled charts, as the stages after packing get them.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "encoder/charts/atlas.h"
#include "encoder/charts/chart_sample.h"
#include "encoder/charts/pack.h"

namespace gim {

struct PackedCharts {
    Atlas atlas;
    Packing packing;
    MultiChartImage image;  // not zippered
};

// Charts that cannot be packed are split, as make_multi_chart_image() does.
inline PackedCharts packed_charts(const Mesh& mesh, uint32_t charts, uint32_t samples, uint64_t seed = 1) {
    const Topology topology = build_topology(mesh);
    AtlasOptions options;
    options.chartify.charts = charts;
    PackedCharts result;
    result.atlas = std::move(build_atlas(mesh, topology, {}, options).value());
    for (int round = 0; round < 10; ++round) {
        const Atlas& atlas = result.atlas;
        std::vector<PackShape> shapes(atlas.charts.size());
        for (size_t c = 0; c < shapes.size(); ++c) {
            for (const uint32_t v : atlas.charts[c].loop) shapes[c].border.push_back(atlas.maps[c].uv[v]);
            shapes[c].least_border = static_cast<uint32_t>(std::max<size_t>(4, 2 * atlas.charts[c].paths.size()));
        }
        result.packing = std::move(pack(shapes, {.most_samples = samples, .effort = 1, .seed = seed}).value());
        if (result.packing.broken.empty()) break;
        auto split = split_charts(mesh, topology, {}, options, result.packing.broken, std::move(result.atlas));
        result.atlas = std::move(split.value());
    }
    result.image = sample_charts(result.atlas.charts, result.atlas.maps, result.packing);
    return result;
}

}  // namespace gim

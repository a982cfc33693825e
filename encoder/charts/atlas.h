// Turns a surface into flattened charts: chartify, straighten, parametrize, and split charts that do not flatten.
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Sections 4.1 and 4.2.
#pragma once

#include <vector>

#include "encoder/charts/chart_parametrize.h"
#include "encoder/charts/chart_set.h"
#include "encoder/charts/chartify.h"
#include "encoder/charts/straighten_charts.h"

namespace gim {

struct AtlasOptions {
    ChartifyOptions chartify;
    StraightenChartsOptions straighten;
    ChartParametrizeOptions parametrize;
    double most_loss = 0.002;  // a chart is split if its flattening costs more than this part of all samples
    int most_splits = 25;      // rounds of splitting
};

struct Atlas {
    Chartification partition;
    std::vector<Chart> charts;
    std::vector<ChartMap> maps;  // each is upright, free of overlap, and at its right size relative to the others
};

// In: an oriented 2-manifold. `importance` per face (empty: 1). Cost: a second or two for 100,000 faces on two cores.
Result<Atlas> build_atlas(const Mesh& mesh, const Topology& topology, const std::vector<double>& importance,
                          const AtlasOptions& options, const Progress& progress = {});

// Splits the given charts, whatever they cost, and flattens the parts. The other charts stay, but their number of paths
// may change.
Result<Atlas> split_charts(const Mesh& mesh, const Topology& topology, const std::vector<double>& importance,
                           const AtlasOptions& options, const std::vector<uint32_t>& charts, Atlas atlas,
                           const Progress& progress = {});

}  // namespace gim

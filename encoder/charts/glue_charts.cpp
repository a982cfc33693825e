#include "encoder/charts/glue_charts.h"

#include <utility>
#include <vector>

namespace gim {

Result<GridGluing> glue_charts(const SampleMask& mask, const SeamRecord& seams) {
    GIM_TRY(point, glue_samples(mask, seams));
    GIM_TRY(paths, path_samples(mask, seams));
    GluedSamples samples;
    samples.width = mask.width;
    samples.height = mask.height;
    samples.defined = mask.defined;
    samples.on_input_boundary.assign(point.size(), false);
    for (size_t p = 0; p < paths.size(); ++p) {
        if (seams.paths[p].mate != kNoMate) continue;
        for (const uint32_t v : paths[p]) samples.on_input_boundary[v] = true;
    }
    samples.classes.resize(point.size());
    for (uint32_t v = 0; v < point.size(); ++v) {
        if (point[v] != kNone) samples.classes[point[v]].push_back(v);
    }
    samples.kind = classify_cells(mask, point);
    return make_gluing(std::move(samples));
}

GridGluing glue_nothing(const SampleMask& mask) {
    std::vector<uint32_t> alone(mask.defined.size(), kNone);
    for (uint32_t v = 0; v < alone.size(); ++v) {
        if (mask.defined[v]) alone[v] = v;
    }
    GluedSamples samples;
    samples.width = mask.width;
    samples.height = mask.height;
    samples.defined = mask.defined;
    samples.on_input_boundary.assign(alone.size(), false);
    samples.kind = classify_cells(mask, alone);
    return make_gluing(std::move(samples));
}

}  // namespace gim

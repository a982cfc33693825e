// Charts of a surface of the corpus, as taken from it, without a fit.
#pragma once

#include "corpus/corpus.h"
#include "encoder/charts/make_charts.h"
#include "encoder/surface/clean.h"

namespace gim::test {

inline ChartLevels corpus_charts(const char* name, uint32_t samples) {
    EncodeOptions options;
    options.layout = Layout::kMcgim;
    options.samples = samples;
    options.charts = 6;
    options.fit = FitStrength::kOff;
    options.density = false;
    const Mesh mesh = clean(corpus::corpus().named(name).mesh()).value().mesh;
    StageClock clock({});
    EncodeReport report;
    return make_charts(mesh, options, options.samples, clock, {}, report).value();
}

}  // namespace gim::test

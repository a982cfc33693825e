#include "encoder/choose_layout.h"

#include "encoder/charts/multi_chart.h"
#include "encoder/squares/square_images.h"

namespace gim {

namespace {

// Effective samples per sample.
double efficiency_of_squares(const Mesh& mesh, EncodeOptions options, StageClock& clock) {
    options.fit = FitStrength::kOff;
    options.density = false;
    options.rate = {};
    EncodeReport report;
    CutPreferences preferences;
    return make_square_images(mesh, options, clock, {}, report, preferences).ok() ? report.stretch_efficiency : 0;
}

double efficiency_of_charts(const Mesh& mesh, const EncodeOptions& options, StageClock& clock) {
    MultiChartOptions quick;
    quick.charts = options.charts;
    quick.samples = options.samples;
    quick.seed = options.seed;
    quick.threads = options.threads;
    quick.fit = std::nullopt;
    const auto charts = make_multi_chart_image(mesh, quick, clock);
    return charts.ok() ? charts.value().stretch_efficiency * charts.value().packing_efficiency : 0;
}

}  // namespace

Layout choose_layout(const Mesh& mesh, const EncodeOptions& options, StageClock& clock) {
    const double squares = efficiency_of_squares(mesh, options, clock);
    if (options.rate.kind != RateTarget::Kind::kLossless) return squares > 0 ? Layout::kGim : Layout::kMcgim;
    return efficiency_of_charts(mesh, options, clock) > squares ? Layout::kMcgim : Layout::kGim;
}

}  // namespace gim

#include "encoder/charts/make_charts.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "encoder/charts/even_axes.h"
#include "encoder/charts/multi_chart.h"
#include "encoder/fit/fit_strength.h"
#include "encoder/image/snapshot.h"
#include "encoder/surface/coarsened.h"

namespace gim {

namespace {

// The most levels to ask for. Charts have too few samples long before.
constexpr uint32_t kMostLevels = 8;

constexpr int kMostDoublings = 5;         // of the samples, until the charts fit
constexpr uint32_t kPackingsIfGrown = 4;  // the bound on samples is exceeded anyway, so the next size is near
constexpr double kLeastEccentricity = 3;  // of surfaces that even axes may help

// Shows the packed charts, and the surface cut open between them.
Snapshot show_packing(std::string caption, const Atlas& atlas, const Packing& packing) {
    const double longer = std::max(packing.width, packing.height) - 1;
    Mesh opened;
    std::vector<std::array<uint32_t, 2>> cut;
    std::vector<Vec2> uv;
    for (size_t c = 0; c < atlas.charts.size(); ++c) {
        const Chart& chart = atlas.charts[c];
        const auto first = static_cast<uint32_t>(opened.positions.size());
        for (size_t v = 0; v < chart.mesh.positions.size(); ++v) {
            opened.positions.push_back(chart.mesh.positions[v]);
            uv.push_back(packing.charts[c].chart.pose(atlas.maps[c].uv[v]) / longer);
        }
        for (const Triangle& t : chart.mesh.triangles)
            opened.triangles.push_back({first + t[0], first + t[1], first + t[2]});
        for (const auto& [a, b] : edges_of_loop(chart.loop)) cut.push_back({first + a, first + b});
    }
    return make_snapshot("charts", std::move(caption), opened, std::move(cut), uv);
}

MultiChartOptions chart_options_of(const EncodeOptions& options) {
    MultiChartOptions chart_options;
    chart_options.charts = options.charts;
    chart_options.samples = options.samples;
    chart_options.density = options.density;
    chart_options.fit = fit_strength(options);
    chart_options.seed = options.seed;
    chart_options.threads = options.threads;
    return chart_options;
}

Result<ChartLevels> charts_within(const Mesh& mesh, const MultiChartOptions& chart_options, StageClock& clock,
                                  const Observer& observer, EncodeReport& report) {
    GIM_TRY(multi_chart, make_multi_chart_image(mesh, chart_options, clock));
    report.stretch_efficiency = multi_chart.stretch_efficiency;
    report.folds_before_fit = multi_chart.before_fit.folds;
    if (observer) {
        char caption[64];
        std::snprintf(caption, sizeof caption, "%zu charts, %.0f%% packed", multi_chart.atlas.charts.size(),
                      100 * multi_chart.packing_efficiency);
        observer(show_packing(caption, multi_chart.atlas, multi_chart.packing));
        if (!multi_chart.sampled.empty()) {
            GeometryImage sampled = multi_chart.image;
            sampled.positions = multi_chart.sampled;
            observer(make_snapshot("image-sampled", "sampled and zipped", sampled));
        }
        observer(make_snapshot("image-fitted", "fitted", multi_chart.image));
    }
    clock.begin(Stage::kSample);
    return make_chart_levels(multi_chart.image, multi_chart.atlas, multi_chart.packing, multi_chart.topology,
                             kMostLevels, chart_options.threads);
}

// Denser surfaces make charts slow and their borders ragged. 0.25 takes 10 % more bytes on a horse of 70 dB, 0.55 about the
// same.
constexpr double kVerticesPerSample = 0.4;

bool lacks_samples(const Result<ChartLevels>& charts) { return !charts.ok() && charts.error().stage == Stage::kSample; }

}  // namespace

Result<ChartLevels> make_charts(const Mesh& whole, const EncodeOptions& asked, uint32_t most_samples, StageClock& clock,
                                const Observer& observer, EncodeReport& report) {
    MultiChartOptions options = chart_options_of(asked);
    const Mesh mesh = is_fitted_to_codec(asked) ? coarsened_to(whole, kVerticesPerSample * options.samples) : whole;
    for (int doublings = 0;; ++doublings, options.samples *= 2) {
        options.even_axes = false;
        auto charts = charts_within(mesh, options, clock, observer, report);
        options.most_packings = kPackingsIfGrown;
        if (lacks_samples(charts) && even_axes(mesh).eccentricity > kLeastEccentricity) {
            options.even_axes = true;
            charts = charts_within(mesh, options, clock, observer, report);
        }
        if (charts.ok() && doublings > 0) {
            report.warnings.push_back("the charts do not fit " + std::to_string(asked.samples) +
                                      " samples; the image has up to " + std::to_string(options.samples));
        }
        if (!lacks_samples(charts) || doublings == kMostDoublings || options.samples > most_samples / 2) return charts;
    }
}

}  // namespace gim

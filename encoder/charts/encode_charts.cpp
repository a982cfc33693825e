#include "encoder/charts/encode_charts.h"

#include <cstdio>
#include <utility>

#include "encoder/base/result.h"
#include "encoder/charts/multi_chart.h"
#include "encoder/charts/write_charts.h"
#include "encoder/fit/fit_strength.h"
#include "encoder/image/snapshot.h"

namespace gim {

namespace {

// Coarser levels than this are never asked for: charts have too few samples long before.
constexpr uint32_t kMostLevels = 8;

}  // namespace

Result<ChartImages> make_charts(const Mesh& mesh, const EncodeOptions& options, StageClock& clock,
                                const Observer& observer, EncodeReport& report) {
    MultiChartOptions chart_options;
    chart_options.charts = options.charts;
    chart_options.samples = options.samples;
    chart_options.density = options.density;
    chart_options.fit = fit_strength(options);
    chart_options.seed = options.seed;
    chart_options.threads = options.threads;
    GIM_TRY(multi_chart, make_multi_chart_image(mesh, chart_options, clock));
    report.stretch_efficiency = multi_chart.stretch_efficiency;
    report.folds = multi_chart.after_fit.folds;
    report.folds_before_fit = multi_chart.before_fit.folds;
    if (observer) {
        char caption[64];
        std::snprintf(caption, sizeof caption, "%zu charts, %.0f%% packed", multi_chart.atlas.charts.size(),
                      100 * multi_chart.packing_efficiency);
        observer(make_snapshot("charts", caption, multi_chart.atlas, multi_chart.packing));
        if (!multi_chart.sampled.empty()) {
            MultiChartImage sampled = multi_chart.image;
            sampled.positions = multi_chart.sampled;
            observer(make_snapshot("image-sampled", "sampled and zipped", sampled));
        }
        observer(make_snapshot("image-fitted", "fitted", multi_chart.image));
    }
    clock.begin(Stage::kSample);
    return make_chart_images(multi_chart.image, multi_chart.atlas, multi_chart.packing, multi_chart.topology,
                             kMostLevels, options.threads);
}

CodingJob code_charts(const ChartImages& charts, EncodeReport& report) {
    report.layout = Layout::kMcgim;
    report.images = 1;
    report.width = charts.image.width();
    report.height = charts.image.height();
    report.samples = charts.sample_count();
    report.defined_samples = charts.defined_count();
    report.charts = static_cast<uint32_t>(charts.charts.size());
    report.cut_paths = static_cast<uint32_t>(charts.mates.size());
    report.packing_efficiency = static_cast<double>(report.defined_samples) / static_cast<double>(report.samples);
    CodingJob job;
    job.make_writer = [&charts](const CodingParameters& parameters) -> Result<std::unique_ptr<FileWriter>> {
        GIM_TRY(writer, ChartFileWriter::create(charts, parameters));
        return std::unique_ptr<FileWriter>(new ChartFileWriter(std::move(writer)));
    };
    job.make_planes = [&charts](const PlaneMaker& maker) { return maker.make(charts.image); };
    return job;
}

}  // namespace gim

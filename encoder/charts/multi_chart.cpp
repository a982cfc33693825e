#include "encoder/charts/multi_chart.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/base/result.h"
#include "encoder/charts/adapt_charts.h"
#include "encoder/charts/atlas.h"
#include "encoder/charts/chart_sample.h"
#include "encoder/charts/chart_slits.h"
#include "encoder/charts/even_axes.h"
#include "encoder/charts/inflate.h"
#include "encoder/charts/pack.h"
#include "encoder/charts/zipper.h"
#include "encoder/surface/creases.h"
#include "encoder/surface/refine.h"

namespace gim {

namespace {

// Edges longer than this part of the root of the surface's area are split, so that charts have faces to choose from.
constexpr double kLongestEdge = 0.045;

// The part of an image that charts usually fill. Used only to judge the density of samples.
constexpr double kUsualPacking = 0.8;

constexpr int kMostSlitRounds = 4;
constexpr uint32_t kMostBridgeRounds = 2;  // each packs again

std::vector<PackShape> shapes_of(const Atlas& atlas) {
    std::vector<PackShape> shapes;
    for (size_t c = 0; c < atlas.charts.size(); ++c) {
        PackShape shape;
        shape.border = border_of(atlas.charts[c], atlas.maps[c].uv);
        // Leave room for a sample between any two cut-nodes.
        shape.least_border = std::max<uint32_t>(4, static_cast<uint32_t>(2 * atlas.charts[c].paths.size()));
        shapes.push_back(std::move(shape));
    }
    return shapes;
}

// The mesh as charts, with all that splitting them needs.
struct ChartedMesh {
    Mesh mesh;  // with short edges
    Topology topology;
    AtlasOptions options;
    std::vector<double> importance;  // per face; empty: 1
    Atlas atlas;
    TopologySummary summary;  // of the mesh

    Result<void> split(const std::vector<uint32_t>& charts, const Progress& progress) {
        auto split = split_charts(mesh, topology, importance, options, charts, std::move(atlas), progress);
        if (!split.ok()) return split.error();
        atlas = std::move(split.value());
        return {};
    }
};

Result<ChartedMesh> cut_into_charts(const Mesh& mesh, const MultiChartOptions& options, StageClock& clock) {
    clock.begin(Stage::kCut);
    ChartedMesh charted;
    charted.mesh = refine_long_edges(mesh, kLongestEdge * std::sqrt(surface_area(mesh)));
    charted.topology = build_topology(charted.mesh);
    charted.options.chartify.charts = options.charts > 0 ? options.charts : automatic_charts(mesh, options.samples);
    charted.options.chartify.seed = options.seed;
    charted.options.parametrize.threads = options.threads;
    GIM_TRY(atlas, build_atlas(charted.mesh, charted.topology, {}, charted.options, clock.progress()));
    charted.atlas = std::move(atlas);
    charted.summary = analyse_topology(charted.mesh.triangles, charted.mesh.positions.size()).summary;
    return charted;
}

// Maps the charts again, denser where the surface needs it.
Result<void> adapt_density(uint32_t most_samples, ChartedMesh& charted, StageClock& clock) {
    clock.begin(Stage::kParametrize);
    const auto samples = static_cast<uint32_t>(kUsualPacking * most_samples);
    auto used = adapt_charts(charted.mesh, samples, kChartDensity, charted.options.parametrize, charted.atlas,
                             clock.progress());
    if (!used.ok()) return used.error();
    charted.importance = std::move(used.value());
    return {};
}

Result<void> split_at_slits(uint32_t most_samples, ChartedMesh& charted, const StageClock& clock) {
    for (int round = 0; round < kMostSlitRounds; ++round) {
        double area = 0;
        for (const ChartMap& map : charted.atlas.maps) area += map.area;
        const std::vector<uint32_t> slit = find_slits(std::sqrt(area / (kUsualPacking * most_samples)), charted.atlas);
        if (slit.empty()) break;
        GIM_CHECK(charted.split(slit, clock.progress()));
    }
    return {};
}

// Makes one attempt at an image of packed charts. Inflates the packing and the maps.
Result<MultiChartImage> sample_and_zip(const ChartedMesh& charted, uint32_t threads, std::vector<ChartMap>& maps,
                                       Packing& packing) {
    InflateOptions options;
    options.threads = threads;
    const std::vector<Chart>& charts = charted.atlas.charts;
    inflate(charts, charted.importance, options, maps, packing);
    return zip(sample_charts(charts, maps, packing, threads), charts, maps, packing);
}

// Packs until the charts have no inlets and the seams close without bridges. Splits charts that do not fit before the
// next attempt. If seams do not close, takes another seed, so that samples fall elsewhere in the next packing.
Result<MultiChart> pack_and_zip(const MultiChartOptions& options, ChartedMesh charted, StageClock& clock) {
    PackOptions pack_options;
    pack_options.most_samples = options.samples;
    pack_options.effort = options.pack_effort;
    pack_options.seed = options.seed;
    pack_options.threads = options.threads;
    MultiChart result;
    for (;; ++result.packings) {
        clock.begin(Stage::kSample);
        GIM_TRY(packing, pack(shapes_of(charted.atlas), pack_options, clock.progress()));
        if (!packing.broken.empty()) {
            if (result.packings >= options.most_packings)
                return Error{Stage::kSample, "charts have inlets narrower than a sample; ask for more samples"};
            clock.begin(Stage::kParametrize);
            GIM_CHECK(charted.split(packing.broken, clock.progress()));
            continue;
        }
        std::vector<ChartMap> maps = charted.atlas.maps;  // the next attempt begins with the maps as they are now
        auto image = sample_and_zip(charted, options.threads, maps, packing);
        if (!image.ok()) {
            if (result.packings >= options.most_packings) return image.error();
            ++pack_options.seed;
            continue;
        }
        if (result.packings <= kMostBridgeRounds) {
            const auto bridged = find_bridges(image.value(), packing, charted.mesh, charted.atlas);
            if (!bridged.empty()) {
                GIM_CHECK(charted.split(bridged, clock.progress()));
                continue;
            }
        }
        result.image = std::move(image.value());
        result.topology = charted.summary;
        result.packing_efficiency =
            static_cast<double>(result.image.mask.count()) / static_cast<double>(result.image.mask.defined.size());
        charted.atlas.maps = std::move(maps);
        result.atlas = std::move(charted.atlas);
        result.packing = std::move(packing);
        return result;
    }
}

Result<MultiChart> charts_of(const Mesh& mesh, const MultiChartOptions& options, StageClock& clock) {
    GIM_TRY(charted, cut_into_charts(mesh, options, clock));
    if (options.density) {
        GIM_CHECK(adapt_density(options.samples, charted, clock));
    }
    GIM_CHECK(split_at_slits(options.samples, charted, clock));
    return pack_and_zip(options, std::move(charted), clock);
}

Result<MultiChart> charts_on_even_axes(const Mesh& mesh, const MultiChartOptions& options, StageClock& clock) {
    const EvenAxes axes = even_axes(mesh);
    Mesh mapped = mesh;
    map_positions(axes.into, mapped.positions);
    GIM_TRY(result, charts_of(mapped, options, clock));
    map_positions(axes.back, result.image.positions);
    for (Chart& chart : result.atlas.charts) map_positions(axes.back, chart.mesh.positions);
    return result;
}

Result<void> fit_samples(const Mesh& mesh, const MultiChartOptions& options, MultiChart& result, StageClock& clock) {
    clock.begin(Stage::kFit);
    FitOptions fit_options;
    fit_options.strength = *options.fit;
    fit_options.thorough = true;
    fit_options.seed = options.seed;
    fit_options.threads = options.threads;
    GIM_TRY(fitted, fit(result.image, mesh, fit_options, clock.progress()));
    result.sampled = std::exchange(result.image.positions, std::move(fitted.positions));
    result.before_fit = fitted.before;
    result.after_fit = fitted.after;
    return {};
}

Result<void> check_topology(const MultiChart& result) {
    const Mesh mesh = surface_of(result.image).mesh;
    if (same_topology(result.topology, analyse_topology(mesh.triangles, mesh.positions.size()).summary)) return {};
    return Error{Stage::kSample, "the image's surface has another topology than the mesh; ask for more samples"};
}

}  // namespace

uint32_t automatic_charts(const Mesh& mesh, uint32_t samples) {
    const double creases = crease_length(mesh) / std::sqrt(surface_area(mesh));
    const double charts = std::min(16 + 3 * creases, 48.0) * std::pow(samples / 65536.0, 0.25);
    return static_cast<uint32_t>(std::clamp(std::round(charts), 6.0, 100.0));
}

Result<MultiChart> make_multi_chart_image(const Mesh& mesh, const MultiChartOptions& options, StageClock& clock) {
    GIM_TRY(result, options.even_axes ? charts_on_even_axes(mesh, options, clock) : charts_of(mesh, options, clock));
    result.stretch_efficiency = stretch_efficiency(result.atlas.charts, result.atlas.maps);
    if (options.fit) {
        GIM_CHECK(fit_samples(mesh, options, result, clock));
    }
    GIM_CHECK(check_topology(result));
    return std::move(result);
}

}  // namespace gim

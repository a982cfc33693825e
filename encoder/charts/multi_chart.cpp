#include "encoder/charts/multi_chart.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/base/result.h"
#include "encoder/charts/adapt_charts.h"
#include "encoder/charts/atlas.h"
#include "encoder/charts/chart_sample.h"
#include "encoder/charts/chart_slits.h"
#include "encoder/charts/inflate.h"
#include "encoder/charts/pack.h"
#include "encoder/charts/zipper.h"
#include "encoder/surface/creases.h"
#include "encoder/surface/refine.h"

namespace gim {

namespace {

// Edges longer than this part of the root of the surface's area are split, so that charts have faces to choose from.
constexpr double kLongestEdge = 0.045;

// The part of an image that charts fill; only to judge density by.
constexpr double kUsualPacking = 0.8;

constexpr int kMostSlitRounds = 4;
constexpr uint32_t kMostBridgeRounds = 2;  // each packs again

std::vector<PackShape> shapes_of(const Atlas& atlas) {
    std::vector<PackShape> shapes;
    for (size_t c = 0; c < atlas.charts.size(); ++c) {
        PackShape shape;
        shape.border = border_of(atlas.charts[c], atlas.maps[c].uv);
        // Room for a sample between any two cut-nodes.
        shape.least_border = std::max<uint32_t>(4, static_cast<uint32_t>(2 * atlas.charts[c].paths.size()));
        shapes.push_back(std::move(shape));
    }
    return shapes;
}

// What the maps' efficiency is inverse to.
double total_cost(const std::vector<ChartMap>& maps) {
    double energy = 0, area = 0;
    for (const ChartMap& map : maps) energy += map.energy, area += map.area;
    return energy * area;
}

}  // namespace

uint32_t automatic_charts(const Mesh& mesh, uint32_t samples) {
    const double creases = crease_length(mesh) / std::sqrt(surface_area(mesh));
    const double charts = std::min(16 + 3 * creases, 48.0) * std::pow(samples / 65536.0, 0.25);
    return static_cast<uint32_t>(std::clamp(std::round(charts), 6.0, 100.0));
}

Result<MultiChart> make_multi_chart_image(const Mesh& mesh, const MultiChartOptions& options, StageClock& clock) {
    clock.begin(Stage::kCut);
    const Mesh fine = refine_long_edges(mesh, kLongestEdge * std::sqrt(surface_area(mesh)));
    const Topology topology = build_topology(fine);
    const TopologySummary wanted = analyse_topology(fine.triangles, fine.positions.size()).summary;
    AtlasOptions atlas_options;
    atlas_options.chartify.charts = options.charts > 0 ? options.charts : automatic_charts(mesh, options.samples);
    atlas_options.chartify.seed = options.seed;
    atlas_options.parametrize.threads = options.threads;
    GIM_TRY(atlas, build_atlas(fine, topology, {}, atlas_options, clock.progress()));

    const double even_efficiency = stretch_efficiency(atlas.charts, atlas.maps);
    std::vector<double> importance;
    if (options.density) {
        clock.begin(Stage::kParametrize);
        const auto samples = static_cast<uint32_t>(kUsualPacking * options.samples);
        GIM_TRY(used, adapt_charts(fine, samples, kChartDensity, atlas_options.parametrize, atlas, clock.progress()));
        importance = std::move(used);
    }

    for (int round = 0; round < kMostSlitRounds; ++round) {
        double area = 0;
        for (const ChartMap& map : atlas.maps) area += map.area;
        const std::vector<uint32_t> slit = find_slits(std::sqrt(area / (kUsualPacking * options.samples)), atlas);
        if (slit.empty()) break;
        GIM_TRY(split,
                split_charts(fine, topology, importance, atlas_options, slit, std::move(atlas), clock.progress()));
        atlas = std::move(split);
    }

    PackOptions pack_options;
    pack_options.most_samples = options.samples;
    pack_options.effort = options.pack_effort;
    pack_options.seed = options.seed;
    pack_options.threads = options.threads;
    constexpr uint32_t kMostPackings = 10;
    MultiChart result;
    result.topology = wanted;
    for (;; ++result.packings) {
        clock.begin(Stage::kSample);
        GIM_TRY(packing, pack(shapes_of(atlas), pack_options, clock.progress()));
        if (!packing.broken.empty()) {
            if (result.packings == kMostPackings)
                return Error{Stage::kSample, "charts have inlets narrower than a sample; ask for more samples"};
            clock.begin(Stage::kParametrize);
            GIM_TRY(split, split_charts(fine, topology, importance, atlas_options, packing.broken, std::move(atlas),
                                        clock.progress()));
            atlas = std::move(split);
            continue;
        }
        // Packed again, if it comes to that, they are as they were.
        std::vector<ChartMap> maps = atlas.maps;
        InflateOptions inflate_options;
        inflate_options.threads = options.threads;
        inflate(atlas.charts, importance, inflate_options, maps, packing);
        auto zipped = zip(sample_charts(atlas.charts, maps, packing, options.threads), atlas.charts, maps, packing);
        if (!zipped.ok()) {
            // Samples fall elsewhere in another packing.
            if (result.packings == kMostPackings) return zipped.error();
            ++pack_options.seed;
            continue;
        }
        if (result.packings <= kMostBridgeRounds) {
            const std::vector<uint32_t> bridged = find_bridges(zipped.value(), packing, fine, atlas);
            if (!bridged.empty()) {
                GIM_TRY(split, split_charts(fine, topology, importance, atlas_options, bridged, std::move(atlas),
                                            clock.progress()));
                atlas = std::move(split);
                continue;
            }
        }
        result.image = std::move(zipped.value());
        result.stretch_efficiency = even_efficiency * total_cost(atlas.maps) / total_cost(maps);
        atlas.maps = std::move(maps);
        result.packing_efficiency =
            static_cast<double>(result.image.mask.count()) / static_cast<double>(result.image.mask.defined.size());
        result.atlas = std::move(atlas);
        result.packing = std::move(packing);
        break;
    }
    if (options.fit) {
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
    }
    const Mesh surface = surface_of(result.image).mesh;
    const TopologySummary found = analyse_topology(surface.triangles, surface.positions.size()).summary;
    if (!same_topology(wanted, found))
        return Error{Stage::kSample, "the image's surface has another topology than the mesh; ask for more samples"};
    return result;
}

}  // namespace gim

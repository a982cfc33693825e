#include "encoder/layouts.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "encoder/charts/charts_layout.h"
#include "encoder/charts/make_charts.h"
#include "encoder/charts/multi_chart.h"
#include "encoder/check_options.h"
#include "encoder/squares/squares_layout.h"
#include "encoder/tiles/best_tiles.h"
#include "encoder/tiles/make_tiles.h"
#include "encoder/tiles/tiles_layout.h"

namespace gim {

namespace {

using Made = Result<std::unique_ptr<LayoutImages>>;

Made squares_of(const MakeImages& in) {
    const uint32_t most_side = in.may_grow ? kMostSide : in.options.side;
    GIM_TRY(squares, make_squares(in.mesh, in.options, most_side, in.clock, in.observer, in.report, in.cuts));
    return squares_layout(std::move(squares), in.options);
}

Made charts_of(const MakeImages& in) {
    const uint32_t most_samples = in.may_grow ? kMostSamples : in.options.samples;
    GIM_TRY(charts, make_charts(in.mesh, in.options, most_samples, in.clock, in.observer, in.report));
    return charts_layout(std::move(charts), in.mesh, in.options);
}

Made tiles_of(const MakeImages& in) {
    in.clock.begin(Stage::kCut);
    GIM_TRY(tiles, make_tiles(in.tileable.of(in.options.creases), in.mesh, in.options, in.clock));
    in.report.stretch_efficiency = tiles.stretch_efficiency;
    in.report.folds_before_fit = tiles.folds_before_fit;
    in.report.hard_edges_kept = in.options.creases ? in.tileable.hard_edges() : 0;
    return tiles_layout(std::move(tiles), in.mesh, in.options);
}

EncodeOptions unfitted(const EncodeOptions& asked) {
    EncodeOptions options = asked;
    options.fit = FitStrength::kOff;
    options.density = false;
    return options;
}

double effective_samples_of_squares(const Mesh& mesh, const EncodeOptions& asked, StageClock& clock) {
    EncodeOptions options = unfitted(asked);
    options.rate = {};
    EncodeReport report;
    CutPreferences preferences;
    const auto squares = make_squares(mesh, options, options.side, clock, {}, report, preferences);
    if (!squares.ok()) return 0;
    double samples = 0;
    for (const SquareImage& image : squares.value().images) samples += double(image.positions.size());
    return report.stretch_efficiency * samples;
}

double effective_samples_of_charts(const Mesh& mesh, const EncodeOptions& options, StageClock& clock) {
    MultiChartOptions quick;
    quick.charts = options.charts;
    quick.samples = options.samples;
    quick.seed = options.seed;
    quick.threads = options.threads;
    quick.density = false;
    quick.fit = std::nullopt;
    const auto charts = make_multi_chart_image(mesh, quick, clock);
    if (!charts.ok()) return 0;
    return charts.value().stretch_efficiency * charts.value().packing_efficiency * options.samples;
}

double effective_samples_of_tiles(const Mesh& mesh, const EncodeOptions& asked, StageClock& clock) {
    EncodeOptions options = unfitted(asked);
    if (options.tiles == 0) options.tiles = tiles_that_fill(options.samples);
    const AuthoredEdges nothing;
    const auto tiles = make_tiles(TileableSurfaces(mesh, nothing).of(options.creases), mesh, options, clock);
    return tiles.ok() ? tiles.value().stretch_efficiency * double(tiles.value().tiles.positions.size()) : 0;
}

constexpr std::array<LayoutEntry, 3> kLayouts = {{
    {Layout::kGim, squares_of, effective_samples_of_squares, true},
    {Layout::kMcgim, charts_of, effective_samples_of_charts, false},
    {Layout::kTiles, tiles_of, effective_samples_of_tiles, true},
}};

}  // namespace

std::span<const LayoutEntry> all_layouts() { return kLayouts; }

const LayoutEntry* find_layout(Layout layout) {
    const auto* found = std::find_if(kLayouts.begin(), kLayouts.end(),
                                     [&](const LayoutEntry& entry) { return entry.layout == layout; });
    return found == kLayouts.end() ? nullptr : found;
}

}  // namespace gim

#include "encoder/charts/chart_levels.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "encoder/base/parallel.h"
#include "encoder/base/result.h"
#include "encoder/charts/chart_sample.h"
#include "encoder/charts/zipper.h"
#include "format/band_code.h"

namespace gim {

namespace {

// All boxes together may have this many times the samples of the rectangle. Without a limit, the margins for the
// coarsest levels would make boxes far larger than their charts.
constexpr uint64_t kMostBoxes = 4;

// The origin of a box's lattice. At level L its sample (column, row) is point (column, row) * 2^L + origin of the
// rectangle.
struct Lattice {
    int64_t column = 0, row = 0;
};

// One chart at all levels. Each mask lies on a lattice that begins at the mask's own corner.
struct ChartPyramid {
    Lattice origin;                  // of level 0
    uint32_t columns = 0, rows = 0;  // of level 0
    std::vector<ChartMask> masks;    // of levels 1, 2, ...; mask.pose leads to the mask
    std::vector<Lattice> corners;    // of the masks, in their level's lattice
};

// The rectangle that the samples of a loop lie in.
struct Extent {
    int64_t first_column = INT64_MAX, last_column = INT64_MIN, first_row = INT64_MAX, last_row = INT64_MIN;

    void add(int64_t column, int64_t row) {
        first_column = std::min(first_column, column);
        last_column = std::max(last_column, column);
        first_row = std::min(first_row, row);
        last_row = std::max(last_row, row);
    }
};

// Rasterises a chart at a coarse level. The chart may grow if it is too small for its cut-nodes or no disk: its box has
// room, and its samples beyond the border continue smoothly. Empty if growing does not help.
std::optional<ChartMask> coarse_mask(const std::vector<Vec2>& border, const ChartPose& pose, size_t least_border,
                                     double least_band) {
    for (const double band : {least_band, least_band + 0.3, least_band + 0.6, least_band + 1}) {
        ChartMask mask = rasterize_chart_on_lattice(border, pose, band);
        if (mask.is_disk && mask.border_length >= least_border) return mask;
    }
    return std::nullopt;
}

// Rasterises a chart at the coarser levels and finds the box that holds all levels. Stops before the first level at
// which the chart is no disk or has no room for its cut-nodes.
ChartPyramid make_pyramid(const Chart& chart, const ChartMap& map, const ChartPose& pose, const Extent& finest,
                          uint32_t most_levels, double band) {
    ChartPyramid pyramid;
    pyramid.origin = {finest.first_column, finest.first_row};
    Extent extent;
    extent.add(0, 0);
    extent.add(finest.last_column - finest.first_column, finest.last_row - finest.first_row);
    const std::vector<Vec2> border = border_of(chart, map.uv);
    for (uint32_t level = 1; level < most_levels; ++level) {
        const double shrink = std::exp2(-static_cast<double>(level));
        ChartPose coarse = pose;
        coarse.scale *= shrink;
        coarse.offset = (pose.offset - Vec2(double(pyramid.origin.column), double(pyramid.origin.row))) * shrink;
        std::optional<ChartMask> made = coarse_mask(border, coarse, std::max<size_t>(4, chart.paths.size()), band);
        if (!made) break;
        ChartMask& mask = *made;
        const Vec2 corner = coarse.offset - mask.pose.offset;
        pyramid.corners.push_back({std::llround(corner.x()), std::llround(corner.y())});
        const Lattice& first = pyramid.corners.back();
        extent.add(first.column << level, first.row << level);
        extent.add((first.column + mask.mask.width - 1) * (int64_t{1} << level),
                   (first.row + mask.mask.height - 1) * (int64_t{1} << level));
        pyramid.masks.push_back(std::move(mask));
    }
    // The origin may only move by whole samples of the coarsest level.
    const auto whole = [&](int64_t before) {
        const auto unit = int64_t{1} << pyramid.masks.size();
        return (before + unit - 1) / unit * unit;
    };
    const int64_t left = whole(-extent.first_column), above = whole(-extent.first_row);
    pyramid.origin.column -= left;
    pyramid.origin.row -= above;
    for (uint32_t level = 1; level <= pyramid.corners.size(); ++level) {
        pyramid.corners[level - 1].column += left >> level;
        pyramid.corners[level - 1].row += above >> level;
    }
    // The box must be large enough to be halved for every level.
    const int64_t least = (int64_t{1} << pyramid.masks.size()) + 1;
    pyramid.columns = static_cast<uint32_t>(std::max(extent.last_column + left + 1, least));
    pyramid.rows = static_cast<uint32_t>(std::max(extent.last_row + above + 1, least));
    return pyramid;
}

// ---- from seam records to borders

// Where a chart's box lies in an image.
struct Placement {
    int64_t column = 0, row = 0;  // of the box's first sample in the image
    uint32_t columns = 0;         // of the box
};

Result<LevelBorders> borders_of(const MultiChartImage& image, const std::vector<Placement>& places) {
    GIM_TRY(paths, path_samples(image.mask, image.seams));
    GIM_TRY(point, glue_samples(image.mask, image.seams));
    LevelBorders borders;
    size_t next = 0;
    for (size_t c = 0; c < places.size(); ++c) {
        const Placement& place = places[c];
        borders.loops.emplace_back();
        for (uint32_t k = 0; k < image.seams.loops[c].path_count; ++k, ++next) {
            borders.lengths.push_back(image.seams.paths[next].length);
            for (size_t i = 0; i + 1 < paths[next].size(); ++i) {
                const int64_t column = paths[next][i] % image.width() - place.column,
                              row = paths[next][i] / image.width() - place.row;
                borders.loops.back().push_back(static_cast<uint32_t>(row * place.columns + column));
            }
        }
    }
    borders.zippers = image.seams.zippers;
    borders.size.triangles = static_cast<uint32_t>(surface_of(image).mesh.triangles.size());
    for (uint32_t i = 0; i < point.size(); ++i) borders.size.vertices += point[i] == i;
    return borders;
}

// Places the charts of a coarser level one below the other and zips them. Empty if the level has to be left out.
std::optional<LevelBorders> zip_level(const Atlas& atlas, const std::vector<ChartPyramid>& pyramids, uint32_t level,
                                      const TopologySummary& wanted, uint32_t threads) {
    Packing packing;
    packing.scale = 1;
    std::vector<Placement> places;
    for (const ChartPyramid& pyramid : pyramids) {
        if (pyramid.masks.size() < level) return std::nullopt;
        PlacedChart placed{pyramid.masks[level - 1], 0, packing.height};
        placed.chart.pose.offset += Vec2(0, packing.height);
        const Lattice& corner = pyramid.corners[level - 1];
        places.push_back({-corner.column, int64_t{packing.height} - corner.row, halved(pyramid.columns, level)});
        packing.width = std::max(packing.width, placed.chart.mask.width);
        packing.height += placed.chart.mask.height + 1;
        packing.charts.push_back(std::move(placed));
    }
    auto zipped = zip(sample_charts(atlas.charts, atlas.maps, packing, threads), atlas.charts, atlas.maps, packing);
    if (!zipped.ok()) return std::nullopt;
    const Mesh mesh = surface_of(zipped.value()).mesh;
    if (!same_topology(wanted, analyse_topology(mesh.triangles, mesh.positions.size()).summary)) return std::nullopt;
    auto borders = borders_of(zipped.value(), places);
    if (!borders.ok()) return std::nullopt;
    return std::move(borders.value());
}

}  // namespace

uint64_t ChartLevels::defined_count() const {
    uint64_t count = 0;
    for (const auto& chart : defined)
        count += static_cast<uint64_t>(std::count(chart.begin(), chart.end(), uint8_t{1}));
    return count;
}

bool same_topology(const TopologySummary& a, const TopologySummary& b) {
    return a.manifold && b.manifold && a.components == b.components && a.boundary_loops == b.boundary_loops &&
           a.genus == b.genus;
}

namespace {

// Makes all levels. On coarser ones, samples up to `band` outside a border belong to its chart.
Result<ChartLevels> make_images(const MultiChartImage& image, const Atlas& atlas, const Packing& packing,
                                const TopologySummary& wanted, uint32_t most_levels, double band, uint32_t threads) {
    GIM_TRY(paths, path_samples(image.mask, image.seams));
    const size_t count = atlas.charts.size();
    std::vector<Extent> extents(count);
    size_t next = 0;
    for (size_t c = 0; c < count; ++c) {
        for (uint32_t k = 0; k < image.seams.loops[c].path_count; ++k) {
            for (const uint32_t i : paths[next++]) extents[c].add(i % image.width(), i / image.width());
        }
    }
    std::vector<ChartPyramid> pyramids(count);
    for (;; --most_levels) {
        parallel_blocks(count, 1, threads, [&](size_t, size_t begin, size_t end) {
            for (size_t c = begin; c < end; ++c)
                pyramids[c] = make_pyramid(atlas.charts[c], atlas.maps[c], packing.charts[c].chart.pose, extents[c],
                                           most_levels, band);
        });
        uint64_t samples = 0;
        for (const ChartPyramid& p : pyramids) samples += uint64_t{p.columns} * p.rows;
        if (most_levels <= 1 || samples <= kMostBoxes * image.mask.defined.size()) break;
    }

    ChartLevels result;
    result.image = image;
    for (const SeamPath& path : image.seams.paths) result.mates.push_back(path.mate);
    std::vector<Placement> places;
    for (size_t c = 0; c < count; ++c) {
        const ChartPyramid& p = pyramids[c];
        ChartBox box;
        box.columns = p.columns;
        box.rows = p.rows;
        box.atlas_column = static_cast<int32_t>(p.origin.column);
        box.atlas_row = static_cast<int32_t>(p.origin.row);
        box.path_count = image.seams.loops[c].path_count;
        result.charts.push_back(box);
        places.push_back({p.origin.column, p.origin.row, p.columns});
        most_levels = std::min(most_levels, box.steps() + 1);
    }
    GIM_TRY(finest, borders_of(image, places));
    result.levels.push_back(std::move(finest));
    for (uint32_t level = 1; level < most_levels; ++level) {
        auto borders = zip_level(atlas, pyramids, level, wanted, threads);
        if (!borders) break;
        result.levels.push_back(std::move(*borders));
    }

    // A chart's samples are those of its mask in the packing, except those that zippering has cut off.
    for (size_t c = 0; c < count; ++c) {
        const ChartBox& box = result.charts[c];
        result.positions.emplace_back(size_t{box.columns} * box.rows, Vec3::Zero());
        result.defined.emplace_back(size_t{box.columns} * box.rows, uint8_t{0});
        const PlacedChart& placed = packing.charts[c];
        const SampleMask& mask = placed.chart.mask;
        for (uint32_t i = 0; i < mask.defined.size(); ++i) {
            const uint32_t column = placed.column + i % mask.width, row = placed.row + i / mask.width;
            const size_t sample = size_t{row} * image.width() + column;
            if (!mask.defined[i] || !image.mask.defined[sample]) continue;
            const size_t at =
                static_cast<size_t>(row - places[c].row) * box.columns + static_cast<size_t>(column - places[c].column);
            result.positions.back()[at] = image.positions[sample];
            result.defined.back()[at] = 1;
        }
    }
    return result;
}

}  // namespace

Result<ChartLevels> make_chart_levels(const MultiChartImage& image, const Atlas& atlas, const Packing& packing,
                                      const TopologySummary& wanted, uint32_t most_levels, uint32_t threads) {
    // If a level's samples happen to lie badly for its zippers, a few more or fewer samples often help.
    constexpr size_t kEnoughLevels = 4;
    GIM_TRY(best, make_images(image, atlas, packing, wanted, most_levels, kBand, threads));
    for (const double band : {0.4, 0.6, 0.3, 0.7}) {
        if (best.levels.size() >= std::min<size_t>(most_levels, kEnoughLevels)) break;
        GIM_TRY(other, make_images(image, atlas, packing, wanted, most_levels, band, threads));
        if (other.levels.size() > best.levels.size()) best = std::move(other);
    }
    return best;
}

}  // namespace gim

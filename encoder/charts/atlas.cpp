#include "encoder/charts/atlas.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "encoder/base/result.h"

namespace gim {

namespace {

constexpr double kSevereStrain = 1.5;

// Flattens charts. A chart that has not changed since the last time keeps its map. Returns whether any was flattened.
Result<bool> flatten(const std::vector<double>& importance, const AtlasOptions& options, const Progress& progress,
                     std::vector<Chart> old_charts, Atlas& atlas) {
    std::vector<ChartMap> old_maps = std::move(atlas.maps);
    atlas.maps.assign(atlas.charts.size(), {});
    std::vector<size_t> changed;
    std::vector<Chart> to_solve;
    for (size_t c = 0; c < atlas.charts.size(); ++c) {
        if (c < old_charts.size() && old_charts[c].source_face == atlas.charts[c].source_face) {
            atlas.maps[c] = std::move(old_maps[c]);
        } else {
            changed.push_back(c);
            to_solve.push_back(atlas.charts[c]);
        }
    }
    GIM_TRY(maps, parametrize_charts(to_solve, importance, options.parametrize, progress));
    for (size_t k = 0; k < changed.size(); ++k) atlas.maps[changed[k]] = std::move(maps[k]);
    return !changed.empty();
}

// Returns the faces of the surface where chart c's border would cross itself. In: its map has a crossing.
std::array<uint32_t, 2> crossing_faces(const Atlas& atlas, uint32_t c) {
    const std::array<uint32_t, 2>& faces = *atlas.maps[c].crossing;
    return {atlas.charts[c].source_face[faces[0]], atlas.charts[c].source_face[faces[1]]};
}

// Takes the charts of the partition apart and flattens them. Splits those that do not flatten, until all do.
Result<Atlas> settle(const Mesh& mesh, const Topology& topology, const std::vector<double>& importance,
                     const AtlasOptions& options, const Progress& progress, Atlas atlas) {
    std::vector<Chart> old_charts = std::move(atlas.charts);
    for (int round = 0;; ++round) {
        atlas.charts = take_apart(mesh, topology, atlas.partition);
        GIM_TRY(solved, flatten(importance, options, progress, std::move(old_charts), atlas));
        bool any = false;
        double whole = 0;
        for (const ChartMap& map : atlas.maps) whole += map.surface;
        for (uint32_t c = 0; solved && c < atlas.charts.size(); ++c) {
            const ChartMap& map = atlas.maps[c];
            if (atlas.charts[c].source_face.size() < 2) continue;
            // At its best scale a map has as much area as stretch energy. Its area beyond the surface's is lost.
            const double taken = std::sqrt(map.energy * map.area), free = taken / std::sqrt(map.strain);
            const double ideal = importance.empty() ? map.surface : free;
            const bool wasteful = taken - ideal > options.most_loss * whole;
            if (!map.overlaps && (!wasteful || round >= options.most_splits)) continue;
            // If there is little strain, part the two places that meet. Otherwise halve the chart.
            std::array<uint32_t, 2> ends{kNone, kNone};
            if (map.crossing && !map.overlaps && map.strain < kSevereStrain && taken - free > free - ideal)
                ends = crossing_faces(atlas, c);
            split_chart(mesh, topology, c, ends, atlas.partition);
            any = true;
        }
        if (!any) return atlas;
        old_charts = std::move(atlas.charts);
    }
}

}  // namespace

Result<Atlas> build_atlas(const Mesh& mesh, const Topology& topology, const std::vector<double>& importance,
                          const AtlasOptions& options, const Progress& progress) {
    if (progress) progress(Stage::kCut, 0);
    Atlas atlas;
    atlas.partition = chartify(mesh, topology, options.chartify);
    straighten_charts(mesh, topology, options.straighten, atlas.partition);
    return settle(mesh, topology, importance, options, progress, std::move(atlas));
}

Result<Atlas> split_charts(const Mesh& mesh, const Topology& topology, const std::vector<double>& importance,
                           const AtlasOptions& options, const std::vector<uint32_t>& charts, Atlas atlas,
                           const Progress& progress) {
    for (const uint32_t c : charts) {
        std::array<uint32_t, 2> ends{kNone, kNone};
        if (atlas.maps[c].crossing) ends = crossing_faces(atlas, c);
        split_chart(mesh, topology, c, ends, atlas.partition);
    }
    return settle(mesh, topology, importance, options, progress, std::move(atlas));
}

}  // namespace gim

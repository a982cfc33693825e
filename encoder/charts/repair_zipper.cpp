#include "encoder/charts/repair_zipper.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "encoder/base/result.h"
#include "encoder/charts/glue_charts.h"
#include "encoder/surface/topology_summary.h"

namespace gim {

namespace {

// A step of kBoth as the border loop of a chart sees it: it leads from point `before` to point `after`.
struct Advance {
    uint32_t before = 0, after = 0;     // representatives
    uint32_t zipper = kNone, step = 0;  // kNone: on an input boundary
};

// Per chart, around its border: one entry for each pair of consecutive different points.
using Walks = std::vector<std::vector<Advance>>;

// Per zipper and step: whether to drop it. A dropped step of kBoth becomes a kFirst and a kSecond.
using Drops = std::vector<std::vector<uint8_t>>;

// Returns the number of each path's zipper, or kNone on an input boundary. Both mates have the same one.
std::vector<uint32_t> zippers_of_paths(const SeamRecord& seams) {
    std::vector<uint32_t> zipper(seams.paths.size(), kNone);
    uint32_t count = 0;
    for (uint32_t p = 0; p < seams.paths.size(); ++p) {
        const uint32_t mate = seams.paths[p].mate;
        if (mate == kNoMate || mate < p) continue;
        zipper[p] = zipper[mate] = count++;
    }
    return zipper;
}

// Returns the advances along one side of a zipper, in the direction of that side's border. own: the side's samples.
std::vector<Advance> advances(const std::vector<ZipStep>& steps, uint32_t zipper, bool is_first,
                              const std::vector<uint32_t>& own, const std::vector<uint32_t>& point) {
    std::vector<Advance> result;
    size_t at = is_first ? 0 : own.size() - 1;  // index into own
    for (uint32_t k = 0; k < steps.size(); ++k) {
        const bool moves = steps[k] == ZipStep::kBoth || steps[k] == (is_first ? ZipStep::kFirst : ZipStep::kSecond);
        const size_t before = at;
        if (moves) is_first ? ++at : --at;
        if (steps[k] != ZipStep::kBoth) continue;
        result.push_back({point[own[is_first ? before : at]], point[own[is_first ? at : before]], zipper, k});
    }
    if (!is_first) std::reverse(result.begin(), result.end());
    return result;
}

// samples: from path_samples(). point: from glue_samples().
Walks walks_of(const SeamRecord& seams, const std::vector<std::vector<uint32_t>>& samples,
               const std::vector<uint32_t>& point) {
    const std::vector<uint32_t> zippers = zippers_of_paths(seams);
    Walks walks;
    uint32_t p = 0;
    for (const SeamRecord::Loop& loop : seams.loops) {
        std::vector<Advance>& around = walks.emplace_back();
        for (uint32_t k = 0; k < loop.path_count; ++k, ++p) {
            const std::vector<uint32_t>& own = samples[p];
            if (zippers[p] == kNone) {
                for (size_t i = 0; i + 1 < own.size(); ++i)
                    around.push_back({point[own[i]], point[own[i + 1]], kNone, 0});
                continue;
            }
            const std::vector<Advance> here =
                advances(seams.zippers[zippers[p]], zippers[p], p < seams.paths[p].mate, own, point);
            around.insert(around.end(), here.begin(), here.end());
        }
    }
    return walks;
}

// Merges the points of a piece of a border: of `length` advances from the i-th on, it drops all but one, on the seam
// with the fewest. Returns false if a seam would be left without a step of kBoth.
bool merge_piece(const std::vector<Advance>& around, size_t i, size_t length, const SeamRecord& seams, Drops& drops) {
    const auto at = [&](size_t k) -> const Advance& { return around[(i + k) % around.size()]; };
    const auto room = [&](size_t k) {
        if (at(k).zipper == kNone) return size_t{0};
        const std::vector<ZipStep>& steps = seams.zippers[at(k).zipper];
        return static_cast<size_t>(std::count(steps.begin(), steps.end(), ZipStep::kBoth));
    };
    size_t keep = 0;
    for (size_t k = 0; k < length; ++k) {
        if (room(k) < room(keep)) keep = k;
    }
    for (size_t k = 0; k < length; ++k) {
        size_t dropped = 0;  // on the same seam
        for (size_t l = 0; l < length; ++l) dropped += l != keep && at(l).zipper == at(k).zipper;
        if (k != keep && room(k) <= dropped) return false;
    }
    for (size_t k = 0; k < length; ++k) {
        if (k != keep) drops[at(k).zipper][at(k).step] = 1;
    }
    return true;
}

// Merges the points between the ends of the doubled edge (a, b) along a short piece of some chart's border. Returns
// false if there is no such piece.
bool flatten(uint32_t a, uint32_t b, const Walks& walks, const SeamRecord& seams, Drops& drops) {
    constexpr size_t kLongestPiece = 6;
    for (const std::vector<Advance>& around : walks) {
        const size_t count = around.size();
        for (size_t i = 0; i < count; ++i) {
            if (around[i].before != a && around[i].before != b) continue;
            const uint32_t end = around[i].before == a ? b : a;
            for (size_t length = 2; length <= std::min(kLongestPiece, count - 2); ++length) {
                if (around[(i + length - 1) % count].after != end) continue;
                if (merge_piece(around, i, length, seams, drops)) return true;
            }
        }
    }
    return false;
}

using Edges = std::set<std::pair<uint32_t, uint32_t>>;  // the smaller point first

// Returns the first sample of each loop that a test accepts. test(loop, index into it).
template <class Test>
std::vector<uint32_t> first_of_each(const std::vector<std::vector<uint32_t>>& loops, const Test& test) {
    std::vector<uint32_t> found;
    for (const std::vector<uint32_t>& loop : loops) {
        size_t k = 0;
        while (k < loop.size() && !test(loop, k)) ++k;
        if (k < loop.size()) found.push_back(loop[k]);
    }
    return found;
}

// Finds tips of single triangles over a doubled edge: without such a tip, the edge is a border edge on that side.
// Returns one per chart at a time, because two that touch must not both go. If there are none, returns ends of doubled
// edges that run across a chart.
std::vector<uint32_t> find_spikes(const MultiChartImage& image, const Edges& doubled,
                                  const std::vector<uint32_t>& point) {
    using Loop = std::vector<uint32_t>;
    const std::vector<Loop> loops = trace_borders(image.mask);
    const auto before = [](const Loop& loop, size_t k) { return loop[(k + loop.size() - 1) % loop.size()]; };
    const auto after = [](const Loop& loop, size_t k) { return loop[(k + 1) % loop.size()]; };
    const auto is_doubled = [&](uint32_t i, uint32_t j) { return doubled.count(std::minmax(point[i], point[j])) > 0; };
    std::vector<uint32_t> spikes = first_of_each(loops, [&](const Loop& loop, size_t k) {
        return is_spike(image.mask, loop[k]) && is_doubled(before(loop, k), after(loop, k));
    });
    if (!spikes.empty()) return spikes;
    const auto apart = [](uint32_t x, uint32_t y) { return std::max(x, y) - std::min(x, y); };
    return first_of_each(loops, [&](const Loop& loop, size_t k) {
        if (!can_remove(image.mask, loop[k])) return false;
        return std::any_of(loop.begin(), loop.end(), [&](uint32_t other) {
            if (other == before(loop, k) || other == after(loop, k) || other == loop[k]) return false;
            if (apart(other % image.width(), loop[k] % image.width()) > 1) return false;
            if (apart(other / image.width(), loop[k] / image.width()) > 1) return false;
            return is_doubled(other, loop[k]);
        });
    });
}

void drop_steps(const Drops& drops, SeamRecord& seams) {
    for (size_t z = 0; z < drops.size(); ++z) {
        std::vector<ZipStep> steps;
        for (size_t k = 0; k < drops[z].size(); ++k) {
            if (drops[z][k]) {
                steps.insert(steps.end(), {ZipStep::kFirst, ZipStep::kSecond});
            } else {
                steps.push_back(seams.zippers[z][k]);
            }
        }
        seams.zippers[z] = std::move(steps);
    }
}

}  // namespace

Result<std::vector<uint32_t>> repair_zippers(MultiChartImage& image, const std::function<void()>& close_seams) {
    GIM_TRY(samples, path_samples(image.mask, image.seams));
    constexpr int kMostRounds = 12;
    for (int round = 0;; ++round) {
        GIM_TRY(gluing, glue_charts(image.mask, image.seams));
        image.gluing = std::move(gluing);
        const std::vector<uint32_t>& point = image.gluing.representative;
        const Surface surface = surface_of(image);
        const TopologyAnalysis analysis = analyse_topology(surface.mesh.triangles, surface.mesh.positions.size());
        if (analysis.summary.manifold) return std::vector<uint32_t>{};
        const Walks walks = walks_of(image.seams, samples, point);
        Drops drops;
        for (const auto& steps : image.seams.zippers) drops.emplace_back(steps.size(), uint8_t{0});
        Edges doubled;
        bool any = false;
        for (const uint32_t e : analysis.nonmanifold_edges) {
            const uint32_t h = analysis.edges.around(e)[0];
            const uint32_t a = surface.sample[from(surface.mesh, h)], b = surface.sample[to(surface.mesh, h)];
            doubled.insert(std::minmax(a, b));
            any |= flatten(a, b, walks, image.seams, drops);
        }
        if (!any || round == kMostRounds) {
            std::vector<uint32_t> spikes = find_spikes(image, doubled, point);
            if (!spikes.empty()) return spikes;
            return charts_too_small(analysis.nonmanifold_edges.size() + analysis.nonmanifold_vertices.size());
        }
        drop_steps(drops, image.seams);
        close_seams();
    }
}

Error charts_too_small(size_t edges) {
    return {Stage::kSample, "the surface comes together at " + std::to_string(edges) +
                                " edges along the seams; the charts are too small for this resolution: ask for more "
                                "samples or fewer charts"};
}

}  // namespace gim

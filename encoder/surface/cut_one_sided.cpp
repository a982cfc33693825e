#include "encoder/surface/cut_one_sided.h"

#include <algorithm>
#include <limits>
#include <queue>

#include "encoder/surface/join_faces.h"
#include "encoder/surface/signed_sets.h"

namespace gim {

namespace {

constexpr size_t kMostSources = 64;
constexpr double kFar = std::numeric_limits<double>::infinity();

// The vertices of a surface and its edges. A side of a vertex is one of the two ways to orient its fan.
class SidedGraph {
  public:
    SidedGraph(const std::vector<Point>& positions, const std::vector<Triangle>& triangles,
               std::span<const uint32_t> twin, const Turning& turning)
        : triangles_(triangles), twin_(twin), sides_(twin.size()) {
        std::vector<uint8_t> is_contradiction(twin.size(), 0);
        for (const uint32_t h : turning.contradictions) is_contradiction[h] = is_contradiction[twin[h]] = 1;
        for_each_join(twin, triangles, [&](const JoinedCorners& j) {
            sides_.unite(j.start, j.start_of_twin, is_contradiction[j.half_edge]);
            sides_.unite(j.end, j.end_of_twin, is_contradiction[j.half_edge]);
        });
        first_.assign(twin.size() + 1, 0);
        for (uint32_t h = 0; h < twin.size(); ++h) {
            if (leads(h)) ++first_[root(h) + 1], ++first_[root(next(h)) + 1];
        }
        for (size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
        arcs_.resize(first_.back());
        std::vector<uint32_t> filled(first_.begin(), first_.end() - 1);
        for (uint32_t h = 0; h < twin.size(); ++h) {
            if (!leads(h)) continue;
            const SignedSets::Place a = sides_.find(h), b = sides_.find(next(h));
            const auto at = [&](uint32_t corner) { return to_vec(positions[vertex(corner)]); };
            const double length = twin[h] == kNone ? 0 : (at(h) - at(next(h))).norm();
            const bool changes_side = a.is_opposite != b.is_opposite;
            arcs_[filled[a.root]++] = {b.root, h, length, changes_side};
            arcs_[filled[b.root]++] = {a.root, h, length, changes_side};
        }
    }

    uint32_t root(uint32_t corner) { return sides_.find(corner).root; }

    // Returns the shortest walk from a vertex to its own other side, as half-edges. Empty if none is below `limit`,
    // which becomes its length.
    std::vector<uint32_t> shortest_loop(uint32_t source, double& limit) {
        const auto state = [](uint32_t v, bool side) { return 2 * size_t{v} + (side ? 1 : 0); };
        distance_.assign(2 * twin_.size(), kFar);
        from_.assign(2 * twin_.size(), {0, kNone});
        using Entry = std::pair<double, size_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        distance_[state(source, false)] = 0;
        queue.push({0, state(source, false)});
        const size_t goal = state(source, true);
        while (!queue.empty()) {
            const auto [length, at] = queue.top();
            queue.pop();
            if (length >= limit) return {};
            if (at == goal) break;
            if (length > distance_[at]) continue;
            const auto v = static_cast<uint32_t>(at / 2);
            for (uint32_t i = first_[v]; i < first_[v + 1]; ++i) {
                const Arc& arc = arcs_[i];
                const size_t to = state(arc.to, (at % 2 != 0) != arc.changes_side);
                if (!(length + arc.length < distance_[to])) continue;
                distance_[to] = length + arc.length;
                from_[to] = {at, arc.half_edge};
                queue.push({distance_[to], to});
            }
        }
        if (distance_[goal] == kFar) return {};
        limit = distance_[goal];
        std::vector<uint32_t> loop;
        for (size_t at = goal; at != state(source, false); at = from_[at].first) loop.push_back(from_[at].second);
        return loop;
    }

  private:
    struct Arc {
        uint32_t to = 0, half_edge = 0;
        double length = 0;
        bool changes_side = false;
    };

    uint32_t vertex(uint32_t corner) const { return triangles_[corner / 3][corner % 3]; }
    bool leads(uint32_t h) const { return twin_[h] == kNone || h < twin_[h]; }

    const std::vector<Triangle>& triangles_;
    std::span<const uint32_t> twin_;
    SignedSets sides_;  // of corners
    std::vector<uint32_t> first_;
    std::vector<Arc> arcs_;
    std::vector<double> distance_;
    std::vector<std::pair<size_t, uint32_t>> from_;
};

// The first contradiction's component alone matters: the others are cut in later rounds.
std::vector<uint32_t> sources_of(const Turning& turning, const Components& components, SidedGraph& graph) {
    std::vector<uint32_t> sources;
    const uint32_t component = components.of_face[face_of(turning.contradictions[0])];
    for (const uint32_t h : turning.contradictions) {
        if (components.of_face[face_of(h)] != component) continue;
        sources.push_back(graph.root(h));
        sources.push_back(graph.root(next(h)));
    }
    std::sort(sources.begin(), sources.end());
    sources.erase(std::unique(sources.begin(), sources.end()), sources.end());
    const size_t step = (sources.size() + kMostSources - 1) / kMostSources;
    std::vector<uint32_t> some;
    for (size_t i = 0; i < sources.size(); i += step) some.push_back(sources[i]);
    return some;
}

}  // namespace

Turning find_turning(const std::vector<Triangle>& triangles, std::span<const uint32_t> twin) {
    SignedSets sheets(triangles.size());
    Turning turning{std::vector<uint8_t>(triangles.size()), {}};
    for_each_join(twin, triangles, [&](const JoinedCorners& j) {
        const bool same_way = j.start_of_twin == twin[j.half_edge];
        if (!sheets.unite(face_of(j.start), face_of(j.start_of_twin), same_way))
            turning.contradictions.push_back(j.half_edge);
    });
    for (uint32_t f = 0; f < triangles.size(); ++f) turning.turn[f] = sheets.find(f).is_opposite;
    return turning;
}

std::vector<uint32_t> cut_one_sided(const std::vector<Point>& positions, const std::vector<Triangle>& triangles,
                                    std::vector<uint32_t>& twin) {
    std::vector<uint32_t> cut;
    const auto cut_at = [&](uint32_t h) {
        if (twin[h] == kNone) return;
        cut.push_back(h);
        twin[twin[h]] = kNone;
        twin[h] = kNone;
    };
    for (;;) {
        const Turning turning = find_turning(triangles, twin);
        if (turning.contradictions.empty()) return cut;
        SidedGraph graph(positions, triangles, twin, turning);
        double limit = kFar;
        std::vector<uint32_t> loop;
        for (const uint32_t source : sources_of(turning, joined_components(twin), graph)) {
            std::vector<uint32_t> found = graph.shortest_loop(source, limit);
            if (!found.empty()) loop = std::move(found);
        }
        const size_t before = cut.size();
        for (const uint32_t h : loop) cut_at(h);
        if (cut.size() == before) {  // every loop runs along boundaries: cut where the faces disagree
            for (const uint32_t h : turning.contradictions) cut_at(h);
        }
    }
}

}  // namespace gim

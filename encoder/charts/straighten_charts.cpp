#include "encoder/charts/straighten_charts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <queue>
#include <unordered_map>

#include "encoder/surface/edge_paths.h"

namespace gim {

namespace {

struct Entry {
    double cost;
    uint32_t vertex;
    bool operator<(const Entry& o) const { return cost != o.cost ? cost > o.cost : vertex > o.vertex; }
};

class Straightener {
  public:
    Straightener(const Mesh& mesh, const Topology& topology, const StraightenChartsOptions& options,
                 Chartification& charts)
        : mesh_(mesh), topology_(topology), options_(options), charts_(charts), label_(charts.chart_of_face) {
        length_.resize(topology.twin.size());
        cost_.resize(topology.twin.size());
        for (uint32_t h = 0; h < length_.size(); ++h) {
            length_[h] = (mesh_.positions[to(mesh_, h)] - mesh_.positions[from(mesh_, h)]).norm();
            cost_[h] = length_[h];
            const uint32_t twin = topology_.twin[h];
            if (twin == kNone) continue;
            const Vec3 a = normal(face_of(h)), b = normal(face_of(twin));
            const double lengths = a.norm() * b.norm();
            if (lengths > 0) cost_[h] /= 1 + options_.crease * std::max(0.0, 1 - a.dot(b) / lengths);
        }
        distance_.assign(mesh_.positions.size(), -1);
        arrival_.assign(mesh_.positions.size(), kNone);
        band_.assign(mesh_.positions.size(), 0);
        area_.assign(charts_.count, 0);
        for (uint32_t f = 0; f < label_.size(); ++f) area_[label_[f]] += face_area(mesh_, f);
    }

    void run() {
        for (int pass = 0; pass < options_.passes; ++pass) {
            faces_.assign(charts_.count, {});
            for (uint32_t f = 0; f < label_.size(); ++f) faces_[label_[f]].push_back(f);
            for (const std::vector<uint32_t>& path : find_paths()) improve(path);
        }
    }

  private:
    Vec3 normal(uint32_t f) const {
        const Triangle& t = mesh_.triangles[f];
        return (mesh_.positions[t[1]] - mesh_.positions[t[0]]).cross(mesh_.positions[t[2]] - mesh_.positions[t[0]]);
    }
    bool is_border(uint32_t h) const {
        const uint32_t twin = topology_.twin[h];
        return twin == kNone || label_[face_of(twin)] != label_[face_of(h)];
    }
    uint32_t border_valence(uint32_t v) const {
        uint32_t valence = 0;
        for_each_outgoing(topology_, v, [&](uint32_t h) {
            valence += is_border(h);
            valence += topology_.twin[prev(h)] == kNone;
        });
        return valence;
    }

    // Returns cut-paths as half-edges, seen from the chart with the smaller number.
    std::vector<std::vector<uint32_t>> find_paths() const {
        std::vector<std::vector<uint32_t>> paths;
        for (uint32_t h = 0; h < topology_.twin.size(); ++h) {
            const uint32_t twin = topology_.twin[h];
            if (twin == kNone || !is_border(h) || label_[face_of(h)] > label_[face_of(twin)]) continue;
            if (border_valence(from(mesh_, h)) == 2) continue;
            std::vector<uint32_t> path{h};
            while (border_valence(to(mesh_, path.back())) == 2) {
                uint32_t n = next(path.back());
                while (!is_border(n)) n = next(topology_.twin[n]);
                path.push_back(n);
            }
            paths.push_back(std::move(path));
        }
        return paths;
    }

    // Returns whether a path still lies between a and b. A neighbour's change may have moved them since the pass began;
    // then the path waits for the next pass.
    bool is_current(const std::vector<uint32_t>& path, uint32_t a, uint32_t b) const {
        return std::all_of(path.begin(), path.end(), [&](uint32_t h) {
            return label_[face_of(h)] == a && label_[face_of(topology_.twin[h])] == b;
        });
    }

    // Marks and returns the vertices near the path that are inside the two charts, or on the path.
    std::vector<uint32_t> mark_band(const std::vector<uint32_t>& path, uint32_t a, uint32_t b, double width) {
        std::vector<uint32_t> reached;
        std::priority_queue<Entry> queue;
        const auto reach = [&](uint32_t v, double d) {
            if (distance_[v] >= 0 && distance_[v] <= d) return;
            if (distance_[v] < 0) reached.push_back(v);
            distance_[v] = d;
            queue.push({d, v});
        };
        for (size_t i = 1; i < path.size(); ++i) band_[from(mesh_, path[i])] = 1, reach(from(mesh_, path[i]), 0);
        reach(from(mesh_, path.front()), 0);
        reach(to(mesh_, path.back()), 0);
        while (!queue.empty()) {
            const Entry entry = queue.top();
            queue.pop();
            if (entry.cost > distance_[entry.vertex]) continue;
            for_each_outgoing(topology_, entry.vertex, [&](uint32_t h) {
                const uint32_t w = to(mesh_, h);
                const uint32_t chart = label_[face_of(h)];
                if ((chart != a && chart != b) || entry.cost + length_[h] > width || topology_.outgoing[w] == kNone)
                    return;
                if (band_[w] == 0 && (border_valence(w) != 0)) return;  // on another border
                band_[w] = 1;
                reach(w, entry.cost + length_[h]);
            });
        }
        for (const uint32_t v : reached) distance_[v] = -1;
        return reached;
    }

    // Finds the cheapest path through the band from the path's begin to its end. Empty if there is none.
    std::vector<uint32_t> cheapest(uint32_t begin, uint32_t end, uint32_t a, uint32_t b) {
        std::vector<uint32_t> reached{begin}, found;
        std::priority_queue<Entry> queue;
        distance_[begin] = 0;
        queue.push({0, begin});
        while (!queue.empty()) {
            const Entry entry = queue.top();
            queue.pop();
            if (entry.cost > distance_[entry.vertex]) continue;
            if (entry.vertex == end) break;
            for_each_outgoing(topology_, entry.vertex, [&](uint32_t h) {
                const uint32_t w = to(mesh_, h), twin = topology_.twin[h];
                if (twin == kNone || (!band_[w] && w != end) || w == begin) return;
                const auto ours = [&](uint32_t chart) { return chart == a || chart == b; };
                if (!ours(label_[face_of(h)]) || !ours(label_[face_of(twin)])) return;
                const double d = entry.cost + cost_[h];
                if (distance_[w] >= 0 && distance_[w] <= d) return;
                if (distance_[w] < 0) reached.push_back(w);
                distance_[w] = d;
                arrival_[w] = h;
                queue.push({d, w});
            });
        }
        if (distance_[end] >= 0) {
            for (uint32_t v = end; v != begin; v = from(mesh_, found.back())) found.push_back(arrival_[v]);
            std::reverse(found.begin(), found.end());
        }
        for (const uint32_t v : reached) distance_[v] = -1;
        return found;
    }

    void improve(const std::vector<uint32_t>& path) {
        const uint32_t a = label_[face_of(path.front())], b = label_[face_of(topology_.twin[path.front()])];
        if (!is_current(path, a, b)) return;
        const uint32_t begin = from(mesh_, path.front()), end = to(mesh_, path.back());
        if (begin == end) return;
        const double width = options_.band * std::sqrt(std::min(area_[a], area_[b]));
        const std::vector<uint32_t> marked = mark_band(path, a, b, width);
        const std::vector<uint32_t> better = cheapest(begin, end, a, b);
        for (const uint32_t v : marked) band_[v] = 0;
        const auto cost = [&](const std::vector<uint32_t>& p) {
            double sum = 0;
            for (const uint32_t h : p) sum += cost_[h];
            return sum;
        };
        if (better.empty() || !(cost(better) < cost(path) * (1 - 1e-6))) return;
        relabel(path, better, a, b);
    }

    // Gives the faces of both charts on the left of the new path to a, the others to b. Undoes it if a disk breaks.
    void relabel(const std::vector<uint32_t>& old_path, const std::vector<uint32_t>& path, uint32_t a, uint32_t b) {
        std::vector<uint32_t> both = faces_[a];
        both.insert(both.end(), faces_[b].begin(), faces_[b].end());
        enum : uint8_t { kOutside, kUnknown, kLeft };
        if (side_.empty()) side_.assign(label_.size(), kOutside), wall_.assign(topology_.twin.size(), 0);
        for (const uint32_t f : both) side_[f] = kUnknown;
        // Walls are the new path, and all of the old border between the two charts except the old path.
        std::vector<uint32_t> walls;
        const auto set_wall = [&](uint32_t h) {
            for (const uint32_t k : {h, topology_.twin[h]}) {
                if (!wall_[k]) wall_[k] = 1, walls.push_back(k);
            }
        };
        for (const uint32_t f : both) {
            for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
                if (topology_.twin[h] != kNone && is_border(h) && side_[face_of(topology_.twin[h])] != kOutside)
                    set_wall(h);
            }
        }
        for (const uint32_t h : old_path) wall_[h] = wall_[topology_.twin[h]] = 0;
        for (const uint32_t h : path) set_wall(h), wall_[h] = wall_[topology_.twin[h]] = 1;

        std::vector<uint32_t> stack{face_of(path.front())}, left;
        side_[stack.back()] = kLeft;
        while (!stack.empty()) {
            const uint32_t f = stack.back();
            stack.pop_back();
            left.push_back(f);
            for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
                if (topology_.twin[h] == kNone || wall_[h]) continue;
                const uint32_t n = face_of(topology_.twin[h]);
                if (side_[n] == kUnknown) side_[n] = kLeft, stack.push_back(n);
            }
        }
        bool clean = left.size() < both.size();
        for (const uint32_t h : path) clean &= side_[face_of(topology_.twin[h])] == kUnknown;
        if (clean) {
            for (const uint32_t f : both) label_[f] = side_[f] == kLeft ? a : b;
            std::vector<uint32_t> right;
            for (const uint32_t f : both) {
                if (side_[f] != kLeft) right.push_back(f);
            }
            if (is_disk(left, a) && is_disk(right, b)) {
                faces_[a] = std::move(left);
                faces_[b] = std::move(right);
            } else {
                for (const uint32_t f : faces_[a]) label_[f] = a;
                for (const uint32_t f : faces_[b]) label_[f] = b;
            }
        }
        for (const uint32_t f : both) side_[f] = kOutside;
        for (const uint32_t h : walls) wall_[h] = 0;
        for (const uint32_t h : old_path) wall_[h] = wall_[topology_.twin[h]] = 0;
    }

    // Returns whether the faces make a disk: Euler characteristic 1, one border loop, every vertex in a single fan.
    // Does not assume that they are connected.
    bool is_disk(const std::vector<uint32_t>& faces, uint32_t chart) {
        int64_t euler = static_cast<int64_t>(faces.size());
        int64_t border = 0;
        uint32_t start = kNone;
        std::unordered_map<uint32_t, uint32_t> fans;  // per vertex: border half-edges that leave it
        for (const uint32_t f : faces) {
            for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
                uint32_t& count = fans[from(mesh_, h)];
                if (is_border(h)) {
                    --euler, ++border, ++count;
                    start = h;
                    if (count > 1) return false;
                } else if (h < topology_.twin[h]) {
                    --euler;
                }
            }
        }
        if (start == kNone || euler + static_cast<int64_t>(fans.size()) != 1) return false;
        int64_t loop = 0;
        uint32_t h = start;
        do {
            ++loop;
            h = next(h);
            while (!is_border(h)) h = next(topology_.twin[h]);
        } while (h != start);
        (void)chart;
        return loop == border;
    }

    const Mesh& mesh_;
    const Topology& topology_;
    const StraightenChartsOptions& options_;
    Chartification& charts_;
    std::vector<uint32_t>& label_;
    std::vector<double> length_, cost_, distance_, area_;
    std::vector<uint32_t> arrival_;
    std::vector<uint8_t> band_, side_, wall_;
    std::vector<std::vector<uint32_t>> faces_;
};

}  // namespace

void straighten_charts(const Mesh& mesh, const Topology& topology, const StraightenChartsOptions& options,
                       Chartification& charts) {
    Straightener(mesh, topology, options, charts).run();
}

}  // namespace gim

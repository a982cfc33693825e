#include "encoder/charts/chartify.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <set>

#include "encoder/surface/edge_paths.h"
#include "encoder/surface/surface_samples.h"

namespace gim {

namespace {

// What the search needs of every face, laid out for speed.
struct DualGraph {
    const Mesh& mesh;
    const Topology& topology;
    std::vector<Vec3> centroid, normal;  // unit normal; zero for a degenerate face
    std::vector<double> area;

    DualGraph(const Mesh& m, const Topology& t) : mesh(m), topology(t) {
        const size_t count = m.triangles.size();
        centroid.resize(count);
        normal.resize(count);
        area.resize(count);
        for (size_t f = 0; f < count; ++f) {
            const Vec3 &a = m.positions[m.triangles[f][0]], &b = m.positions[m.triangles[f][1]],
                       &c = m.positions[m.triangles[f][2]];
            const Vec3 twice = (b - a).cross(c - a);
            const double length = twice.norm();
            centroid[f] = (a + b + c) / 3;
            normal[f] = length > 0 ? Vec3(twice / length) : Vec3::Zero();
            area[f] = length / 2;
        }
    }
    size_t faces() const { return area.size(); }
    uint32_t neighbour(uint32_t f, uint32_t i) const {
        const uint32_t twin = topology.twin[3 * f + i];
        return twin == kNone ? kNone : face_of(twin);
    }
};

struct Entry {
    double cost;
    uint32_t face, chart;
    // Smallest cost first; ties by number, so that the order is the same everywhere.
    bool operator<(const Entry& o) const {
        if (cost != o.cost) return cost > o.cost;
        return face != o.face ? face > o.face : chart > o.chart;
    }
};

// Faces assigned to charts, and the local test that keeps every chart a disk with a simple border.
class Partition {
  public:
    Partition(const DualGraph& graph, std::vector<uint32_t> labels) : graph_(&graph), label_(std::move(labels)) {}
    explicit Partition(const DualGraph& graph) : graph_(&graph), label_(graph.faces(), kNone) {}

    uint32_t operator[](uint32_t f) const { return label_[f]; }
    void assign(uint32_t f, uint32_t chart) { label_[f] = chart; }
    std::vector<uint32_t>& labels() { return label_; }

    bool touches(uint32_t vertex, uint32_t chart) const {
        bool found = false;
        for_each_outgoing(graph_->topology, vertex, [&](uint32_t h) { found |= label_[face_of(h)] == chart; });
        return found;
    }
    // Returns whether the chart stays a disk with f. They must meet in one arc: one edge and not the opposite corner,
    // or two edges.
    bool can_join(uint32_t f, uint32_t chart) const {
        int shared = 0;
        uint32_t shared_edge = 0;
        for (uint32_t i = 0; i < 3; ++i) {
            const uint32_t n = graph_->neighbour(f, i);
            if (n != kNone && label_[n] == chart) ++shared, shared_edge = i;
        }
        if (shared == 2) return true;
        return shared == 1 && !touches(graph_->mesh.triangles[f][(shared_edge + 2) % 3], chart);
    }

  private:
    const DualGraph* graph_;
    std::vector<uint32_t> label_;
};

// ---- phase 1: chart growth ----------------------------------------------------------------------------------------

struct Growth {
    Partition partition;
    std::vector<uint32_t> seeds;  // those given, and those that had to be added
    uint32_t last_face = kNone;   // the last face assigned
};

// Grows charts over the faces with in_region (empty: all of them).
Growth grow(const DualGraph& graph, std::vector<uint32_t> seeds, double planarity,
            const std::vector<uint8_t>& in_region = {}) {
    Growth result{Partition(graph), std::move(seeds), kNone};
    Partition& partition = result.partition;
    std::vector<Vec3> normal_sum;
    std::priority_queue<Entry> queue;
    std::vector<uint32_t> refused;
    constexpr double kSharp = 0.5;  // a chart rather ends than goes on if the cosine between faces is below this
    const double chart_size = std::sqrt(std::accumulate(graph.area.begin(), graph.area.end(), 0.0) /
                                        static_cast<double>(result.seeds.size()));
    const auto take = [&](uint32_t f, uint32_t chart, double cost) {
        partition.assign(f, chart);
        result.last_face = f;
        normal_sum[chart] += graph.area[f] * graph.normal[f];
        const double length = normal_sum[chart].norm();
        const Vec3 normal = length > 0 ? Vec3(normal_sum[chart] / length) : Vec3::Zero();
        for (uint32_t i = 0; i < 3; ++i) {
            const uint32_t n = graph.neighbour(f, i);
            if (n == kNone || partition[n] != kNone || (!in_region.empty() && !in_region[n])) continue;
            const double step =
                (planarity - normal.dot(graph.normal[n])) * (graph.centroid[n] - graph.centroid[f]).norm();
            const double crease = std::max(0.0, kSharp - graph.normal[f].dot(graph.normal[n])) * chart_size;
            queue.push({cost + std::max(step, 0.0) + crease, n, chart});
        }
    };
    for (uint32_t c = 0; c < result.seeds.size(); ++c) {
        normal_sum.push_back(Vec3::Zero());
        take(result.seeds[c], c, 0);
    }
    uint32_t unreached = 0;
    size_t next_refused = 0;
    for (;;) {
        while (!queue.empty()) {
            const Entry entry = queue.top();
            queue.pop();
            if (partition[entry.face] != kNone) continue;
            if (partition.can_join(entry.face, entry.chart)) {
                take(entry.face, entry.chart, entry.cost);
            } else {
                refused.push_back(entry.face);
            }
        }
        // A face that is left lies in a component without a seed or closes a chart up. The first one becomes a seed.
        while (next_refused < refused.size() && partition[refused[next_refused]] != kNone) ++next_refused;
        uint32_t seed = next_refused < refused.size() ? refused[next_refused] : kNone;
        if (seed == kNone) {
            while (unreached < graph.faces() &&
                   (partition[unreached] != kNone || (!in_region.empty() && !in_region[unreached])))
                ++unreached;
            if (unreached == graph.faces()) return result;
            seed = unreached;
        }
        normal_sum.push_back(Vec3::Zero());
        result.seeds.push_back(seed);
        take(seed, static_cast<uint32_t>(normal_sum.size() - 1), 0);
    }
}

// ---- phase 2: seeds -----------------------------------------------------------------------------------------------

// Finds the most interior face of each chart: the one farthest from the border along the dual graph.
std::vector<uint32_t> interior_seeds(const DualGraph& graph, const Partition& partition, uint32_t count) {
    std::vector<double> distance(graph.faces(), -1);
    std::priority_queue<Entry> queue;
    for (uint32_t f = 0; f < graph.faces(); ++f) {
        if (partition[f] == kNone) continue;
        double nearest = -1;
        for (uint32_t i = 0; i < 3; ++i) {
            const uint32_t n = graph.neighbour(f, i);
            if (n != kNone && partition[n] == partition[f]) continue;
            const Vec3& a = graph.mesh.positions[graph.mesh.triangles[f][i]];
            const Vec3& b = graph.mesh.positions[graph.mesh.triangles[f][(i + 1) % 3]];
            const double d = (graph.centroid[f] - (a + b) / 2).norm();
            nearest = nearest < 0 ? d : std::min(nearest, d);
        }
        if (nearest >= 0) queue.push({nearest, f, partition[f]});
    }
    std::vector<uint32_t> seeds(count, kNone);
    std::vector<double> farthest(count, -1);
    while (!queue.empty()) {
        const Entry entry = queue.top();
        queue.pop();
        if (distance[entry.face] >= 0) continue;
        distance[entry.face] = entry.cost;
        if (entry.cost > farthest[entry.chart]) farthest[entry.chart] = entry.cost, seeds[entry.chart] = entry.face;
        for (uint32_t i = 0; i < 3; ++i) {
            const uint32_t n = graph.neighbour(entry.face, i);
            if (n == kNone || partition[n] != entry.chart || distance[n] >= 0) continue;
            queue.push({entry.cost + (graph.centroid[n] - graph.centroid[entry.face]).norm(), n, entry.chart});
        }
    }
    return seeds;
}

// Adds up to `wanted` seeds while bootstrapping. Takes the farthest face of each of the charts that ran farthest, so
// new seeds are far from every seed and spread out.
void add_far_seeds(const DualGraph& graph, const Growth& growth, uint32_t wanted, std::vector<uint32_t>& seeds) {
    // Growth does not keep the cost to reach a face. Distance from the chart's seed serves as well and is cheap.
    // Planarity is a little above 1, so that flat charts are split too if no others are left.
    constexpr double kPlanarity = 1.001;
    const auto count = static_cast<uint32_t>(growth.seeds.size());
    std::vector<double> spread(count, 0);
    std::vector<uint32_t> farthest(count, kNone);
    std::vector<Vec3> normal(count, Vec3::Zero());
    for (uint32_t f = 0; f < graph.faces(); ++f) normal[growth.partition[f]] += graph.area[f] * graph.normal[f];
    for (Vec3& n : normal) n = n.norm() > 0 ? Vec3(n.normalized()) : n;
    for (uint32_t f = 0; f < graph.faces(); ++f) {
        const uint32_t c = growth.partition[f];
        const double d = (kPlanarity - normal[c].dot(graph.normal[f])) *
                         (graph.centroid[f] - graph.centroid[growth.seeds[c]]).norm();
        if (d > spread[c]) spread[c] = d, farthest[c] = f;
    }
    std::vector<uint32_t> order(count);
    for (uint32_t c = 0; c < count; ++c) order[c] = c;
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return spread[a] > spread[b]; });
    for (const uint32_t c : order) {
        if (wanted == 0) return;
        if (farthest[c] == kNone || std::find(seeds.begin(), seeds.end(), farthest[c]) != seeds.end()) continue;
        seeds.push_back(farthest[c]);
        --wanted;
    }
}

// ---- afterwards ---------------------------------------------------------------------------------------------------

// Hands an ear of a chart (a face with one neighbour inside) to a chart at its other edges if that shortens the border.
// Both charts stay disks.
void straighten(const DualGraph& graph, Partition& partition, uint32_t count) {
    std::vector<uint32_t> size(count, 0);
    for (uint32_t f = 0; f < graph.faces(); ++f) ++size[partition[f]];
    std::vector<uint32_t> queue(graph.faces());
    for (uint32_t f = 0; f < graph.faces(); ++f) queue[f] = f;
    const auto edge_length = [&](uint32_t f, uint32_t i) {
        const Triangle& t = graph.mesh.triangles[f];
        return (graph.mesh.positions[t[(i + 1) % 3]] - graph.mesh.positions[t[i]]).norm();
    };
    size_t budget = 8 * graph.faces();
    for (size_t at = 0; at < queue.size() && budget > 0; ++at, --budget) {
        const uint32_t f = queue[at], own = partition[f];
        int inside = 0;
        for (uint32_t i = 0; i < 3; ++i) {
            const uint32_t n = graph.neighbour(f, i);
            inside += n != kNone && partition[n] == own;
        }
        if (inside != 1 || size[own] < 2) continue;
        double best_gain = 0;
        uint32_t best = kNone;
        for (uint32_t i = 0; i < 3; ++i) {
            const uint32_t n = graph.neighbour(f, i);
            if (n == kNone || partition[n] == own) continue;
            double gain = 0;
            for (uint32_t k = 0; k < 3; ++k) {
                const uint32_t m = graph.neighbour(f, k);
                if (m == kNone) continue;
                if (partition[m] == partition[n]) gain += edge_length(f, k);
                if (partition[m] == own) gain -= edge_length(f, k);
            }
            if (gain > best_gain * (1 + 1e-9) && gain > 1e-9 * edge_length(f, i) && partition.can_join(f, partition[n]))
                best_gain = gain, best = partition[n];
        }
        if (best == kNone) continue;
        partition.assign(f, best);
        --size[own], ++size[best];
        for (uint32_t i = 0; i < 3; ++i) {
            for_each_outgoing(graph.topology, graph.mesh.triangles[f][i],
                              [&](uint32_t h) { queue.push_back(face_of(h)); });
        }
    }
}

// Renumbers charts 0 .. count-1 in the order of their first faces.
uint32_t renumber(std::vector<uint32_t>& labels) {
    std::vector<uint32_t> number;
    uint32_t count = 0;
    for (uint32_t& label : labels) {
        if (label >= number.size()) number.resize(label + 1, kNone);
        if (number[label] == kNone) number[label] = count++;
        label = number[label];
    }
    return count;
}

// Returns whether two disks make one. They do if they meet in a single arc and at no vertex apart from it: then the
// Euler characteristic 1 + 1 - (common vertices - common edges) is 1.
bool meet_in_one_arc(const DualGraph& graph, const Partition& partition, const std::vector<uint32_t>& faces_of_a,
                     uint32_t a, uint32_t b) {
    std::set<uint32_t> common_vertices;
    size_t common_edges = 0;
    for (const uint32_t f : faces_of_a) {
        for (uint32_t i = 0; i < 3; ++i) {
            const uint32_t n = graph.neighbour(f, i);
            common_edges += n != kNone && partition[n] == b;
            const uint32_t v = graph.mesh.triangles[f][i];
            if (partition.touches(v, b)) common_vertices.insert(v);
        }
    }
    (void)a;
    return common_edges > 0 && common_vertices.size() == common_edges + 1;
}

// Merges pairs of charts that make one disk, while there are more charts than wanted. Takes the flattest pair first.
void merge_surplus(const DualGraph& graph, Partition& partition, uint32_t count, uint32_t wanted) {
    std::vector<std::vector<uint32_t>> faces(count);
    std::vector<Vec3> normal(count, Vec3::Zero());
    for (uint32_t f = 0; f < graph.faces(); ++f) {
        faces[partition[f]].push_back(f);
        normal[partition[f]] += graph.area[f] * graph.normal[f];
    }
    uint32_t left = count;
    std::set<std::pair<uint32_t, uint32_t>> hopeless;
    while (left > wanted) {
        // The loss of flatness of a merge: |n_a| + |n_b| - |n_a + n_b|.
        std::set<std::pair<uint32_t, uint32_t>> pairs;
        for (uint32_t f = 0; f < graph.faces(); ++f) {
            for (uint32_t i = 0; i < 3; ++i) {
                const uint32_t n = graph.neighbour(f, i);
                if (n != kNone && partition[n] != partition[f]) pairs.insert(std::minmax(partition[f], partition[n]));
            }
        }
        double least = 0;
        std::pair<uint32_t, uint32_t> best{kNone, kNone};
        for (const auto& [a, b] : pairs) {
            if (hopeless.contains({a, b})) continue;
            const double loss = normal[a].norm() + normal[b].norm() - (normal[a] + normal[b]).norm();
            if (best.first != kNone && loss >= least) continue;
            const uint32_t small = faces[a].size() <= faces[b].size() ? a : b, large = small == a ? b : a;
            if (!meet_in_one_arc(graph, partition, faces[small], small, large)) {
                hopeless.insert({a, b});
                continue;
            }
            least = loss, best = {a, b};
        }
        // A merge that folds a chart over would cost more than the chart it saves.
        if (best.first == kNone || least > 0.3 * std::min(normal[best.first].norm(), normal[best.second].norm()))
            return;
        const auto [a, b] = best;
        for (const uint32_t f : faces[b]) partition.assign(f, a);
        faces[a].insert(faces[a].end(), faces[b].begin(), faces[b].end());
        faces[b].clear();
        normal[a] += normal[b];
        --left;
        std::erase_if(hopeless,
                      [&, merged = a](const auto& pair) { return pair.first == merged || pair.second == merged; });
    }
}

}  // namespace

Chartification chartify(const Mesh& mesh, const Topology& topology, const ChartifyOptions& options) {
    Chartification result;
    if (mesh.triangles.empty()) return result;
    const DualGraph graph(mesh, topology);
    const uint32_t wanted = std::clamp<uint32_t>(options.charts, 1, static_cast<uint32_t>(graph.faces()));
    std::vector<uint32_t> seeds{static_cast<uint32_t>(mix_bits(options.seed) % graph.faces())};

    // Bootstrapping: grow, move the seeds inside, add some far away.
    Growth growth = grow(graph, seeds, options.planarity);
    while (growth.seeds.size() < wanted) {
        const auto count = static_cast<uint32_t>(growth.seeds.size());
        seeds = interior_seeds(graph, growth.partition, count);
        growth.seeds = seeds;
        add_far_seeds(graph, growth, std::min(wanted - count, 1 + count / 5), seeds);
        if (seeds.size() == count) break;  // every face is a seed
        growth = grow(graph, seeds, options.planarity);
    }
    // Lloyd rounds until the seeds repeat (those of the last round, or a cycle).
    std::set<std::vector<uint32_t>> seen;
    for (int round = 0; round < options.most_rounds; ++round) {
        seeds = interior_seeds(graph, growth.partition, static_cast<uint32_t>(growth.seeds.size()));
        std::vector<uint32_t> key = seeds;
        std::sort(key.begin(), key.end());
        if (!seen.insert(std::move(key)).second) break;
        growth = grow(graph, seeds, options.planarity);
    }

    const auto count = static_cast<uint32_t>(growth.seeds.size());
    merge_surplus(graph, growth.partition, count, wanted);
    straighten(graph, growth.partition, count);
    result.chart_of_face = std::move(growth.partition.labels());
    result.count = renumber(result.chart_of_face);
    return result;
}

void split_chart(const Mesh& mesh, const Topology& topology, uint32_t chart, std::array<uint32_t, 2> ends,
                 Chartification& charts) {
    const DualGraph graph(mesh, topology);
    std::vector<uint8_t> in_region(graph.faces(), 0);
    std::vector<uint32_t> faces;
    for (uint32_t f = 0; f < graph.faces(); ++f) {
        in_region[f] = charts.chart_of_face[f] == chart;
        if (in_region[f]) faces.push_back(f);
    }
    if (faces.size() < 2) return;
    const auto farthest_from = [&](const Vec3& p) {
        return *std::max_element(faces.begin(), faces.end(), [&](uint32_t a, uint32_t b) {
            return (graph.centroid[a] - p).squaredNorm() < (graph.centroid[b] - p).squaredNorm();
        });
    };
    const bool given = ends[0] != kNone && ends[1] != kNone && ends[0] != ends[1];
    if (!given) {
        ends[0] = farthest_from(graph.centroid[faces.front()]);
        ends[1] = farthest_from(graph.centroid[ends[0]]);
        if (ends[0] == ends[1]) ends[1] = faces.front() == ends[0] ? faces.back() : faces.front();
    }
    // Grow mostly by distance. If normals helped here, the chart would need no split. Given ends must stay apart, so
    // they get no Lloyd rounds.
    constexpr double kMostlyDistance = 2;
    std::vector<uint32_t> seeds(ends.begin(), ends.end());
    Growth growth = grow(graph, seeds, kMostlyDistance, in_region);
    for (int round = 0; round < (given ? 0 : 5); ++round) {
        seeds = interior_seeds(graph, growth.partition, static_cast<uint32_t>(growth.seeds.size()));
        growth = grow(graph, seeds, kMostlyDistance, in_region);
    }
    for (const uint32_t f : faces) {
        const uint32_t part = growth.partition[f];
        if (part > 0) charts.chart_of_face[f] = charts.count + part - 1;
    }
    charts.count += static_cast<uint32_t>(growth.seeds.size()) - 1;
}

double mean_normal_deviation(const Mesh& mesh, const Chartification& charts) {
    std::vector<Vec3> normal(charts.count, Vec3::Zero());
    double area = 0, along = 0;
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        const Vec3 n = (mesh.positions[t[1]] - mesh.positions[t[0]]).cross(mesh.positions[t[2]] - mesh.positions[t[0]]);
        normal[charts.chart_of_face[f]] += n;
        area += n.norm();
    }
    for (const Vec3& n : normal) along += n.norm();  // = sum of the faces' components along their chart's normal
    return area > 0 ? 1 - along / area : 0;
}

bool charts_are_disks(const Mesh& mesh, const Topology& topology, const Chartification& charts) {
    if (charts.chart_of_face.size() != mesh.triangles.size()) return false;
    // A chart must have Euler characteristic 1 and one simple border loop. Its faces at a vertex must be one fan.
    std::vector<int64_t> euler(charts.count, 0), border(charts.count, 0), loop(charts.count, 0);
    std::vector<uint32_t> first(charts.count, kNone);
    const auto chart_at = [&](uint32_t h) { return charts.chart_of_face[face_of(h)]; };
    const auto is_border = [&](uint32_t h) {
        return topology.twin[h] == kNone || chart_at(topology.twin[h]) != chart_at(h);
    };
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        const uint32_t c = chart_at(h);
        if (c >= charts.count) return false;
        if (h % 3 == 0) ++euler[c];
        if (is_border(h)) {
            --euler[c], ++border[c];
            first[c] = h;
        } else if (h < topology.twin[h]) {
            --euler[c];
        }
    }
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        if (topology.outgoing[v] == kNone) continue;
        // The chart of each fan and of each face around v. A fan begins at a border half-edge that leaves v.
        std::vector<uint32_t> fans, around;
        for_each_outgoing(topology, v, [&](uint32_t h) {
            if (is_border(h)) fans.push_back(chart_at(h));
            around.push_back(chart_at(h));
        });
        if (fans.empty()) fans.push_back(around.front());
        std::sort(fans.begin(), fans.end());
        if (std::adjacent_find(fans.begin(), fans.end()) != fans.end()) return false;
        for (const uint32_t c : fans) ++euler[c];
    }
    for (uint32_t c = 0; c < charts.count; ++c) {
        if (first[c] == kNone || euler[c] != 1) return false;
        uint32_t h = first[c];
        do {
            ++loop[c];
            h = next(h);
            while (!is_border(h)) h = next(topology.twin[h]);
        } while (h != first[c]);
        if (loop[c] != border[c]) return false;
    }
    return true;
}

}  // namespace gim

#include "encoder/surface/progressive_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <queue>

#include "encoder/base/parallel.h"
#include "encoder/surface/quadric.h"

namespace gim {

ProgressiveMesh::ProgressiveMesh(const Mesh& mesh) : alive_(mesh.triangles.size(), 1) {
    Topology topology = build_topology(mesh);
    origin_.reserve(3 * mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) origin_.insert(origin_.end(), t.begin(), t.end());
    twin_ = std::move(topology.twin);
    outgoing_ = std::move(topology.outgoing);
    vertex_count_ =
        static_cast<uint32_t>(std::count_if(outgoing_.begin(), outgoing_.end(), [](uint32_t h) { return h != kNone; }));
}

void ProgressiveMesh::pair(uint32_t a, uint32_t b) {
    if (a != kNone) twin_[a] = b;
    if (b != kNone) twin_[b] = a;
}

bool ProgressiveMesh::can_collapse(uint32_t h) const {
    const uint32_t vertex = origin(h), into = target(h);
    if (on_boundary(vertex)) return false;
    // Link condition: the two ends have exactly two neighbours in common.
    int common = 0, valence_vertex = 0, valence_into = 0;
    for_each_neighbour(into, [&](uint32_t) { ++valence_into; });
    for_each_neighbour(vertex, [&](uint32_t n) {
        ++valence_vertex;
        if (n == into) return;
        bool shared = false;
        for_each_neighbour(n, [&](uint32_t m) { shared |= m == into; });
        common += shared;
    });
    return common == 2 && !(valence_vertex == 3 && valence_into == 3);
}

void ProgressiveMesh::repair_outgoing(uint32_t v, uint32_t candidate) {
    // `candidate` leaves v and is alive. On a boundary vertex the loop moves to the half-edge without a twin.
    uint32_t h = candidate;
    while (twin_[h] != kNone) {
        h = next(twin_[h]);
        if (h == candidate) break;
    }
    outgoing_[v] = h;
}

void ProgressiveMesh::collapse(uint32_t h) {
    const uint32_t t = twin_[h];
    const uint32_t vertex = origin(h), into = target(h);
    const uint32_t left = origin(prev(h)), right = origin(prev(t));
    Collapse record{h,
                    vertex,
                    into,
                    {twin_[next(h)], twin_[prev(h)], twin_[next(t)], twin_[prev(t)]},
                    {outgoing_[vertex], outgoing_[into], outgoing_[left], outgoing_[right]}};

    for_each_outgoing(vertex, [&](uint32_t out) { origin_[out] = into; });
    pair(record.outer[0], record.outer[1]);
    pair(record.outer[2], record.outer[3]);
    alive_[face_of(h)] = alive_[face_of(t)] = 0;

    // outer[1] leaves `into` towards left, outer[2] leaves right towards `into`. `vertex` was interior, so both exist.
    outgoing_[vertex] = kNone;
    repair_outgoing(into, record.outer[1]);
    repair_outgoing(left, next(record.outer[1]));
    repair_outgoing(right, record.outer[2]);
    --vertex_count_;
    collapses_.push_back(record);
}

VertexSplit ProgressiveMesh::split() {
    const Collapse record = collapses_.back();
    collapses_.pop_back();
    const uint32_t h = record.edge;
    // The faces between outer[1] and outer[2] around `into` go back to `vertex`.
    for (uint32_t out = record.outer[1];; out = twin_[prev(out)]) {
        origin_[out] = record.vertex;
        if (prev(out) == record.outer[2]) break;
    }
    alive_[face_of(h)] = 1;
    const uint32_t t = twin_[h];
    alive_[face_of(t)] = 1;
    origin_[h] = record.vertex;
    origin_[next(t)] = record.vertex;
    pair(next(h), record.outer[0]);
    pair(prev(h), record.outer[1]);
    pair(next(t), record.outer[2]);
    pair(prev(t), record.outer[3]);
    const uint32_t left = origin(prev(h)), right = origin(prev(t));
    outgoing_[record.vertex] = record.outgoing[0];
    outgoing_[record.into] = record.outgoing[1];
    outgoing_[left] = record.outgoing[2];
    outgoing_[right] = record.outgoing[3];
    ++vertex_count_;
    return {record.vertex, record.into, left, right, h};
}

ProgressiveMesh::Compacted ProgressiveMesh::compact(const std::vector<Vec3>& positions) const {
    Compacted result;
    std::vector<uint32_t> number(outgoing_.size(), kNone);
    for (uint32_t v = 0; v < outgoing_.size(); ++v) {
        if (removed(v)) continue;
        number[v] = static_cast<uint32_t>(result.vertices.size());
        result.vertices.push_back(v);
        result.mesh.positions.push_back(positions[v]);
    }
    for (uint32_t f = 0; f < alive_.size(); ++f) {
        if (!alive_[f]) continue;
        result.faces.push_back(f);
        result.mesh.triangles.push_back(
            {number[origin_[3 * f]], number[origin_[3 * f + 1]], number[origin_[3 * f + 2]]});
    }
    return result;
}

// ---- simplification -------------------------------------------------------------------------------------------------

namespace {

// Weight of edge length against quadric error. It is small, so that edge length decides in flat regions only.
constexpr double kShortEdgeWeight = 3e-3;
// A collapse must not turn a face by more than about 78 degrees.
constexpr double kLeastNormalCosine = 0.2;

class Simplifier {
  public:
    Simplifier(ProgressiveMesh& mesh, const std::vector<Vec3>& positions, const SimplifyOptions& options)
        : mesh_(mesh),
          positions_(positions),
          options_(options),
          quadrics_(positions.size()),
          area_(positions.size(), 0.0),
          version_(positions.size(), 0),
          queued_(positions.size(), 0) {
        for (uint32_t h = 0; h < mesh_.half_edge_count(); h += 3) {
            if (mesh_.alive(face_of(h))) add_face(h);
        }
    }

    // Keeps faces well-shaped first. If that gets stuck (slivers, narrow strips), goes on by connectivity alone.
    void run() {
        run_phase();
        keep_shape_ = false;
        if (options_.insist) run_phase();
    }

  private:
    void run_phase() {
        fill_queue();
        while (mesh_.vertex_count() > options_.target_vertices && !queue_.empty()) {
            const Entry entry = queue_.top();
            queue_.pop();
            if (entry.version != version_[entry.vertex] || mesh_.removed(entry.vertex)) continue;
            queued_[entry.vertex] = 0;
            const Candidate now = best(entry.vertex);  // neighbours may have changed since
            if (now.edge == kNone) continue;
            if (now.cost > entry.cost * (1 + 1e-9)) {
                enqueue(entry.vertex, now);
                continue;
            }
            collapse(now.edge);
        }
    }

    struct Entry {
        double cost;
        uint32_t vertex, version;
        // Smallest cost first; ties by vertex, so that the order is the same everywhere.
        bool operator<(const Entry& o) const { return cost != o.cost ? cost > o.cost : vertex > o.vertex; }
    };
    struct Candidate {
        double cost = 0;
        uint32_t edge = kNone;
    };

    void add_face(uint32_t h) {
        const uint32_t t[3] = {mesh_.origin(h), mesh_.origin(h + 1), mesh_.origin(h + 2)};
        const Vec3 n = (positions_[t[1]] - positions_[t[0]]).cross(positions_[t[2]] - positions_[t[0]]);
        const double twice_area = n.norm();
        for (const uint32_t v : t) {
            area_[v] += twice_area / 6;
            if (twice_area > 0) {
                const Vec3 unit = n / twice_area;
                quadrics_[v].add_plane(unit, -unit.dot(positions_[t[0]]), twice_area / 6);
            }
        }
    }

    // Returns whether origin(h) may move onto target(h). No face around it may turn over, and no edge may lie along a
    // side of the square.
    bool allowed(uint32_t h) const {
        const uint32_t v = mesh_.origin(h), w = mesh_.target(h);
        const uint32_t left = mesh_.origin(prev(h)), right = mesh_.origin(prev(mesh_.twin(h)));
        return mesh_.all_outgoing(v, [&](uint32_t out) {
            const uint32_t a = mesh_.target(out), b = mesh_.origin(prev(out));
            if (!options_.sides.empty() && a != w && a != left && a != right &&
                (options_.sides[a] & options_.sides[w]) != 0)
                return false;
            if (a == w || b == w || !keep_shape_) return true;
            const Vec3 before = (positions_[a] - positions_[v]).cross(positions_[b] - positions_[v]);
            const Vec3 after = (positions_[a] - positions_[w]).cross(positions_[b] - positions_[w]);
            const double limit = before.norm() * after.norm();
            if (!(before.dot(after) > kLeastNormalCosine * limit) && before.squaredNorm() != 0) return false;
            // Needles are refused: an obtuse sliver is worth nothing to the coarse solve.
            const double longest =
                std::max({(positions_[a] - positions_[w]).squaredNorm(), (positions_[b] - positions_[w]).squaredNorm(),
                          (positions_[a] - positions_[b]).squaredNorm()});
            return after.norm() > 0.02 * longest || after.norm() >= before.norm();
        });
    }

    Candidate best(uint32_t v) const {
        Candidate result;
        if (mesh_.removed(v) || mesh_.on_boundary(v)) return result;
        mesh_.for_each_outgoing(v, [&](uint32_t h) {
            const uint32_t w = mesh_.target(h);
            const double error = std::max(0.0, quadrics_[v](positions_[w]) + quadrics_[w](positions_[w]));
            const double cost = error + kShortEdgeWeight * area_[v] * (positions_[v] - positions_[w]).squaredNorm();
            if (result.edge != kNone && cost >= result.cost) return;
            if (!allowed(h) || !mesh_.can_collapse(h)) return;
            result = {cost, h};
        });
        return result;
    }

    void enqueue(uint32_t v, const Candidate& candidate) {
        queue_.push({candidate.cost, v, ++version_[v]});
        queued_[v] = 1;
    }
    void fill_queue() {
        std::vector<Candidate> candidates(positions_.size());
        parallel_blocks(candidates.size(), 4096, 0, [&](size_t, size_t begin, size_t end) {
            for (size_t v = begin; v < end; ++v) candidates[v] = best(static_cast<uint32_t>(v));
        });
        std::vector<Entry> entries;
        for (uint32_t v = 0; v < candidates.size(); ++v) {
            if (candidates[v].edge == kNone) continue;
            entries.push_back({candidates[v].cost, v, ++version_[v]});
            queued_[v] = 1;
        }
        queue_ = std::priority_queue<Entry>({}, std::move(entries));
    }
    void push(uint32_t v) {
        const Candidate candidate = best(v);
        if (candidate.edge != kNone) enqueue(v, candidate);
    }

    void collapse(uint32_t h) {
        const uint32_t v = mesh_.origin(h), w = mesh_.target(h);
        mesh_.collapse(h);
        quadrics_[w] += quadrics_[v];
        area_[w] += area_[v];
        push(w);
        // Queued neighbours are looked at again when their turn comes. Those that were stuck get a new chance now.
        mesh_.for_each_neighbour(w, [&](uint32_t n) {
            if (!queued_[n]) push(n);
        });
    }

    ProgressiveMesh& mesh_;
    const std::vector<Vec3>& positions_;
    const SimplifyOptions& options_;
    std::vector<Quadric> quadrics_;
    std::vector<double> area_;
    std::vector<uint32_t> version_;
    std::vector<uint8_t> queued_;
    std::priority_queue<Entry> queue_;
    bool keep_shape_ = true;
};

}  // namespace

void simplify(ProgressiveMesh& mesh, const std::vector<Vec3>& positions, const SimplifyOptions& options) {
    Simplifier(mesh, positions, options).run();
}

}  // namespace gim

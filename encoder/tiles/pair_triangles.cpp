#include "encoder/tiles/pair_triangles.h"

#include <algorithm>
#include <cmath>

#include "encoder/surface/topology_summary.h"
#include "encoder/tiles/perfect_matching.h"
#include "encoder/tiles/quad_shape.h"

namespace gim {

namespace {

constexpr double kCreasePenalty = 1000;
constexpr double kDoubletPenalty = 5;
constexpr double kValencePenalty = 0.25;  // per squared difference from four quads
constexpr double kWeightScale = 1e6;
constexpr int kRounds = 40;

// One component of the base. Triangles are numbered inside of it.
class Pairing {
  public:
    Pairing(const std::vector<Vec3>& positions, const BaseMesh& base, const Topology& topology,
            std::vector<uint32_t> triangles, std::vector<double>& price, const std::vector<uint32_t>& faces_at)
        : positions_(positions),
          base_(base),
          topology_(topology),
          triangles_(std::move(triangles)),
          price_(price),
          faces_at_(faces_at) {
        find_edges();
    }

    // Per triangle of the component its diagonal, a half-edge of the base; nothing if there is no perfect matching.
    std::vector<uint32_t> run();

  private:
    struct Edge {
        uint32_t half_edge;  // the lower one of two
        uint32_t a, b;       // triangles
        double shape;
    };
    void find_edges();
    std::vector<uint32_t> match();
    double judge(const std::vector<uint32_t>& diagonals);
    void adapt_prices(double step);
    uint32_t origin(uint32_t h) const { return base_.triangles[h / 3][h % 3]; }
    bool open_at(uint32_t v) const { return topology_.twin[topology_.outgoing[v]] == kNone; }

    const std::vector<Vec3>& positions_;
    const BaseMesh& base_;
    const Topology& topology_;
    std::vector<uint32_t> triangles_;
    std::vector<double>& price_;             // per vertex: what a diagonal that ends there is worth
    const std::vector<uint32_t>& faces_at_;  // per vertex
    std::vector<Edge> edges_;
    std::vector<uint32_t> vertices_;
    std::vector<uint32_t> quads_at_;  // per vertex of vertices_
};

void Pairing::find_edges() {
    std::vector<uint32_t> number(base_.triangles.size(), kNone);
    for (uint32_t i = 0; i < triangles_.size(); ++i) number[triangles_[i]] = i;
    for (uint32_t i = 0; i < triangles_.size(); ++i) {
        for (uint32_t h = 3 * triangles_[i]; h < 3 * triangles_[i] + 3; ++h) {
            vertices_.push_back(origin(h));
            const uint32_t t = topology_.twin[h];
            if (t == kNone || t < h) continue;
            const Vec3 &a = positions_[origin(next(h))], &c = positions_[origin(h)];
            double shape = quad_shape(a, positions_[origin(prev(h))], c, positions_[origin(prev(t))]);
            const uint32_t low = std::min(origin(h), origin(t)), high = std::max(origin(h), origin(t));
            if (std::binary_search(base_.creases.begin(), base_.creases.end(), std::array<uint32_t, 2>{low, high}))
                shape -= kCreasePenalty;
            edges_.push_back({h, i, number[face_of(t)], shape});
        }
    }
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
}

std::vector<uint32_t> Pairing::match() {
    std::vector<WeightedEdge> weighted;
    for (const Edge& e : edges_) {
        const double weight = e.shape + price_[origin(e.half_edge)] + price_[origin(next(e.half_edge))];
        weighted.push_back({e.a, e.b, std::llround(weight * kWeightScale)});
    }
    const std::vector<uint32_t> partner = perfect_matching(static_cast<uint32_t>(triangles_.size()), weighted);
    std::vector<uint32_t> diagonals(partner.size());
    for (const Edge& e : edges_) {
        if (!partner.empty() && partner[e.a] == e.b) diagonals[e.a] = diagonals[e.b] = e.half_edge;
    }
    return diagonals;
}

double Pairing::judge(const std::vector<uint32_t>& diagonals) {
    double value = 0;
    quads_at_.assign(vertices_.size(), 0);
    const auto slot = [&](uint32_t v) {
        return static_cast<size_t>(std::lower_bound(vertices_.begin(), vertices_.end(), v) - vertices_.begin());
    };
    for (size_t i = 0; i < vertices_.size(); ++i) quads_at_[i] = faces_at_[vertices_[i]];
    for (const Edge& e : edges_) {
        if (diagonals[e.a] != e.half_edge) continue;
        value += e.shape;
        --quads_at_[slot(origin(e.half_edge))];
        --quads_at_[slot(origin(next(e.half_edge)))];
    }
    for (size_t i = 0; i < vertices_.size(); ++i) {
        if (open_at(vertices_[i])) continue;
        const double off = static_cast<double>(quads_at_[i]) - 4;
        value -= kValencePenalty * off * off + (quads_at_[i] == 2 ? kDoubletPenalty : 0);
    }
    return value;
}

void Pairing::adapt_prices(double step) {
    for (size_t i = 0; i < vertices_.size(); ++i) {
        if (open_at(vertices_[i])) continue;
        const double off = static_cast<double>(quads_at_[i]) - 4;
        price_[vertices_[i]] += quads_at_[i] <= 2 ? -1 : step * off;
    }
}

std::vector<uint32_t> Pairing::run() {
    for (const uint32_t v : vertices_) {
        const double t = faces_at_[v];
        price_[v] = open_at(v) ? 0 : 0.15 * (t - 5) - (t == 3 ? 20 : 0) - (t == 4 ? 0.6 : 0);
    }
    std::vector<uint32_t> best = match();
    if (best.empty()) return best;
    double best_value = judge(best);
    for (int round = 0; round < kRounds; ++round) {
        adapt_prices(0.25 / (1 + 0.2 * round));
        std::vector<uint32_t> diagonals = match();
        const double value = judge(diagonals);
        if (value > best_value) {
            best_value = value;
            best = std::move(diagonals);
        }
    }
    return best;
}

// Adds the quads of a component.
void add_quads(const BaseMesh& base, const Topology& topology, const std::vector<uint32_t>& diagonals,
               QuadPairing& result) {
    const auto origin = [&](uint32_t h) { return base.triangles[h / 3][h % 3]; };
    std::vector<uint32_t> once = diagonals;
    std::sort(once.begin(), once.end());
    once.erase(std::unique(once.begin(), once.end()), once.end());
    for (const uint32_t h : once) {
        const uint32_t t = topology.twin[h], a = origin(next(h)), c = origin(h);
        result.quads.push_back({a, origin(prev(h)), c, origin(prev(t))});
        result.triangles.push_back({face_of(h), face_of(t)});
        const std::array<uint32_t, 2> edge{std::min(a, c), std::max(a, c)};
        if (std::binary_search(base.creases.begin(), base.creases.end(), edge)) result.crossed.push_back(edge);
    }
}

}  // namespace

QuadPairing pair_triangles(const std::vector<Vec3>& positions, const BaseMesh& base) {
    QuadPairing result;
    const Topology topology = build_topology({positions, base.triangles});
    const Components components = connected_components(base.triangles, positions.size());
    std::vector<std::vector<uint32_t>> triangles(components.count);
    for (uint32_t f = 0; f < base.triangles.size(); ++f) triangles[components.of_face[f]].push_back(f);
    std::vector<uint32_t> faces_at(positions.size(), 0);
    for (const Triangle& t : base.triangles) {
        for (const uint32_t v : t) ++faces_at[v];
    }
    std::vector<double> price(positions.size(), 0);
    for (const std::vector<uint32_t>& part : triangles) {
        const std::vector<uint32_t> diagonals = Pairing(positions, base, topology, part, price, faces_at).run();
        if (diagonals.empty()) {
            result.unpaired.insert(result.unpaired.end(), part.begin(), part.end());
        } else {
            add_quads(base, topology, diagonals, result);
        }
    }
    for (const auto& q : result.quads) --faces_at[q[0]], --faces_at[q[2]];
    for (uint32_t v = 0; v < positions.size(); ++v) {
        const uint32_t h = topology.outgoing[v];
        if (h != kNone && topology.twin[h] != kNone && faces_at[v] == 2) result.doublets.push_back(v);
    }
    return result;
}

}  // namespace gim

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

// What all components share.
struct Whole {
    const std::vector<Vec3>& positions;
    const BaseMesh& base;
    const Topology topology;
    std::vector<uint32_t> faces_at;  // per vertex
    std::vector<double> price;       // per vertex: what a diagonal that ends there is worth
    std::vector<uint32_t> number;    // per triangle: its place in its component
};

// One component of the base. Triangles are numbered inside of it.
class Pairing {
  public:
    Pairing(Whole& whole, const std::vector<uint32_t>& triangles)
        : positions_(whole.positions),
          base_(whole.base),
          topology_(whole.topology),
          faces_at_(whole.faces_at),
          price_(whole.price),
          triangles_(triangles) {
        for (uint32_t i = 0; i < triangles_.size(); ++i) whole.number[triangles_[i]] = i;
        find_edges(whole.number);
    }

    // Per triangle of the component its diagonal, a half-edge of the base; nothing if there is no perfect matching.
    std::vector<uint32_t> run(uint32_t rounds);

  private:
    struct Edge {
        uint32_t half_edge;  // the lower one of two
        uint32_t a, b;       // triangles
        double shape;
    };
    void find_edges(const std::vector<uint32_t>& number);
    std::vector<uint32_t> match();
    double judge(const std::vector<uint32_t>& diagonals);
    void adapt_prices(double step);
    uint32_t origin(uint32_t h) const { return base_.triangles[h / 3][h % 3]; }
    bool open_at(uint32_t v) const { return topology_.twin[topology_.outgoing[v]] == kNone; }

    const std::vector<Vec3>& positions_;
    const BaseMesh& base_;
    const Topology& topology_;
    const std::vector<uint32_t>& faces_at_;
    std::vector<double>& price_;
    const std::vector<uint32_t>& triangles_;
    std::vector<Edge> edges_;
    std::vector<uint32_t> vertices_;
    std::vector<uint32_t> quads_at_;  // per vertex of vertices_
};

void Pairing::find_edges(const std::vector<uint32_t>& number) {
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

std::vector<uint32_t> Pairing::run(uint32_t rounds) {
    for (const uint32_t v : vertices_) {
        const double t = faces_at_[v];
        price_[v] = open_at(v) ? 0 : 0.15 * (t - 5) - (t == 3 ? 20 : 0) - (t == 4 ? 0.6 : 0);
    }
    std::vector<uint32_t> best = match();
    if (best.empty()) return best;
    double best_value = judge(best);
    for (uint32_t round = 0; round < rounds; ++round) {
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

uint32_t count_twins(std::vector<std::array<uint32_t, 4>> quads) {
    for (auto& q : quads) std::sort(q.begin(), q.end());
    std::sort(quads.begin(), quads.end());
    uint32_t twins = 0;
    for (size_t i = 1; i < quads.size(); ++i) twins += quads[i] == quads[i - 1];
    return twins;
}

void find_doublets(const Whole& whole, QuadPairing& result) {
    std::vector<uint32_t> quads_at = whole.faces_at;
    for (const auto& quad : result.quads) --quads_at[quad[0]], --quads_at[quad[2]];
    for (const uint32_t f : result.unpaired) {
        for (const uint32_t v : whole.base.triangles[f]) quads_at[v] = kNone;
    }
    for (uint32_t v = 0; v < quads_at.size(); ++v) {
        const uint32_t h = whole.topology.outgoing[v];
        if (h != kNone && whole.topology.twin[h] != kNone && quads_at[v] == 2) result.doublets.push_back(v);
    }
}

}  // namespace

QuadPairing pair_triangles(const std::vector<Vec3>& positions, const BaseMesh& base, uint32_t rounds) {
    QuadPairing result;
    Whole whole{positions,
                base,
                build_topology({positions, base.triangles}),
                std::vector<uint32_t>(positions.size(), 0),
                std::vector<double>(positions.size(), 0),
                std::vector<uint32_t>(base.triangles.size(), kNone)};
    for (const Triangle& t : base.triangles) {
        for (const uint32_t v : t) ++whole.faces_at[v];
    }
    const Components components = connected_components(base.triangles, positions.size());
    std::vector<std::vector<uint32_t>> triangles(components.count);
    for (uint32_t f = 0; f < base.triangles.size(); ++f) triangles[components.of_face[f]].push_back(f);
    for (const std::vector<uint32_t>& part : triangles) {
        const std::vector<uint32_t> diagonals = Pairing(whole, part).run(rounds);
        if (diagonals.empty()) {
            result.unpaired.insert(result.unpaired.end(), part.begin(), part.end());
        } else {
            add_quads(base, whole.topology, diagonals, result);
        }
    }
    result.twins = count_twins(result.quads);
    find_doublets(whole, result);
    return result;
}

}  // namespace gim

#include "encoder/tiles/crease_rails.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace gim {

namespace {

constexpr double kRounding = 1e-6;  // of barycentric coordinates

// The creases of a mesh, cut into curves at their corners.
class CreaseCurves {
  public:
    CreaseCurves(const Mesh& mesh, const std::vector<bool>& sharp) : ends_(mesh.positions.size()) {
        const Topology topology = build_topology(mesh);
        on_boundary_.resize(mesh.positions.size());
        for (uint32_t h = 0; h < topology.twin.size(); ++h) {
            const uint32_t twin = topology.twin[h], a = from(mesh, h), b = to(mesh, h);
            if (twin == kNone) {
                on_boundary_[a] = on_boundary_[b] = true;
            } else if (h < twin && (sharp[h] || sharp[twin])) {
                ends_[a].push_back(b);
                ends_[b].push_back(a);
            }
        }
        for (uint32_t v = 0; v < ends_.size(); ++v) {
            if (is_corner(v)) follow_all(v);
        }
        for (uint32_t v = 0; v < ends_.size(); ++v) follow_all(v);  // closed curves
    }

    bool is_corner(uint32_t v) const { return !ends_[v].empty() && (ends_[v].size() != 2 || on_boundary_[v]); }
    // Returns the curve that holds an edge, or kNone.
    uint32_t curve_of(uint32_t a, uint32_t b) const {
        const auto found = curve_of_.find(key(a, b));
        return found == curve_of_.end() ? kNone : found->second;
    }
    // Returns the curve through a vertex that is no corner, or kNone.
    uint32_t curve_at(uint32_t v) const { return ends_[v].empty() ? kNone : curve_of(v, ends_[v][0]); }
    const std::vector<std::vector<uint32_t>>& curves() const { return curves_; }

  private:
    static uint64_t key(uint32_t a, uint32_t b) { return uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

    void follow_all(uint32_t v) {
        for (const uint32_t next : ends_[v]) {
            if (curve_of(v, next) == kNone) follow(v, next);
        }
    }
    void follow(uint32_t v, uint32_t next) {
        const auto number = static_cast<uint32_t>(curves_.size());
        std::vector<uint32_t> curve{v};
        while (curve_of_.try_emplace(key(v, next), number).second) {
            curve.push_back(next);
            if (is_corner(next)) break;
            const uint32_t on = ends_[next][ends_[next][0] == v ? 1 : 0];
            v = next;
            next = on;
        }
        curves_.push_back(std::move(curve));
    }

    std::vector<std::vector<uint32_t>> ends_;  // per vertex: the other ends of its crease edges
    std::vector<bool> on_boundary_;
    std::vector<std::vector<uint32_t>> curves_;  // their vertices
    std::unordered_map<uint64_t, uint32_t> curve_of_;
};

// Returns the curve that a point lies on; kNone if it lies on none, or at a corner.
uint32_t curve_at(const CreaseCurves& curves, const TileMap& map, const SurfacePoint& point) {
    const Triangle& t = map.triangles[point.triangle];
    uint32_t curve = kNone;
    for (size_t i = 0; i < 3; ++i) {
        if (point.barycentric[i] > 1 - kRounding) return curves.is_corner(t[i]) ? kNone : curves.curve_at(t[i]);
        if (std::abs(point.barycentric[i]) > kRounding) continue;
        curve = std::min(curve, curves.curve_of(t[(i + 1) % 3], t[(i + 2) % 3]));
    }
    return curve;
}

// Returns the curve that all samples lie on, but for less than half of them that lie on none; else kNone. A vertex of a crease
// that found no room on the border of its tiles (TileMap::stray) takes a few samples off it. Fits put them back on their rail.
uint32_t curve_of_most(const std::vector<uint32_t>& curve_of_sample) {
    const uint32_t curve = *std::min_element(curve_of_sample.begin(), curve_of_sample.end());
    const auto on = static_cast<size_t>(std::count(curve_of_sample.begin(), curve_of_sample.end(), curve));
    const auto off = static_cast<size_t>(std::count(curve_of_sample.begin(), curve_of_sample.end(), kNone));
    if (curve == kNone || on + off < curve_of_sample.size() || on <= off) return kNone;
    return curve;
}

}  // namespace

CreaseRails crease_rails(const Mesh& dense, const std::vector<bool>& sharp, const TileMap& map,
                         const std::vector<SurfacePoint>& points, const QuadComplex& complex, uint32_t side) {
    CreaseRails result;
    result.half_edge.assign(complex.half_edges(), false);
    if (std::find(sharp.begin(), sharp.end(), true) == sharp.end()) return result;

    const CreaseCurves curves(dense, sharp);
    std::vector<uint32_t>& curve_of = result.rails.of_sample;
    curve_of.assign(points.size(), kNone);
    for (const std::vector<uint32_t>& curve : curves.curves()) {
        result.rails.curves.emplace_back();
        for (const uint32_t v : curve) result.rails.curves.back().push_back(dense.positions[v]);
    }
    const TileSamples samples(complex, side);
    std::vector<uint32_t> ends;  // of edges on creases: vertices of the complex
    for (uint32_t e = 0; e < complex.edges; ++e) {
        const uint32_t h = complex.lower[e];
        std::vector<uint32_t> curve_of_inner;
        for (uint32_t t = 1; t < side; ++t)
            curve_of_inner.push_back(curve_at(curves, map, points[samples.along(h, t)]));
        const uint32_t curve = curve_of_most(curve_of_inner);
        if (curve == kNone) continue;
        result.half_edge[h] = true;
        if (complex.mate[h] != kNoMate) result.half_edge[complex.mate[h]] = true;
        for (uint32_t t = 1; t < side; ++t) curve_of[samples.along(h, t)] = curve;
        ends.push_back(complex.vertex[h]);
        ends.push_back(complex.vertex[next_side(h)]);
    }
    for (const uint32_t end : ends) {
        if (curve_of[end] != kNone) continue;
        const SurfacePoint& point = points[end];
        const size_t corner = static_cast<size_t>(std::max_element(point.barycentric.begin(), point.barycentric.end()) -
                                                  point.barycentric.begin());
        const uint32_t v = map.triangles[point.triangle][corner];
        if (curves.is_corner(v)) {
            curve_of[end] = static_cast<uint32_t>(result.rails.curves.size());
            result.rails.curves.push_back({dense.positions[v]});
        } else {
            curve_of[end] = curves.curve_at(v);
        }
    }
    return result;
}

}  // namespace gim

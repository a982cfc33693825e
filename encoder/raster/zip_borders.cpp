#include "encoder/raster/zip_borders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "encoder/raster/cell_index.h"
#include "encoder/raster/raster_surface.h"
#include "format/chart_ramp.h"

namespace gim {
namespace {

using Edge = std::array<uint32_t, 2>;  // samples

// The edges of the image's surface that only one triangle has.
std::vector<Edge> open_edges(uint32_t width, uint32_t height, std::span<const float> units,
                             const RasterGluing& gluing) {
    std::vector<std::pair<Edge, Edge>> edges;  // points, samples
    for (const Triangle& t : raster_triangles(gluing, width, height, units)) {
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = t[k], b = t[(k + 1) % 3];
            const auto [low, high] = std::minmax(gluing.point[a], gluing.point[b]);
            edges.push_back({{low, high}, {a, b}});
        }
    }
    std::sort(edges.begin(), edges.end());
    std::vector<Edge> open;
    for (size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        while (end < edges.size() && edges[end].first == edges[begin].first) ++end;
        if (end - begin == 1) open.push_back(edges[begin].second);
    }
    return open;
}

class Zipper {
  public:
    Zipper(uint32_t width, const std::vector<Vec3>& positions, double tolerance, std::vector<Edge> edges,
           RasterGluing& gluing)
        : width_(width),
          positions_(positions),
          tolerance_(tolerance),
          edges_(std::move(edges)),
          gluing_(gluing),
          spacing_(positions.size(), std::numeric_limits<double>::infinity()),
          role_(positions.size(), Role::kNone),
          cells_(cell_size()) {
        for (uint32_t e = 0; e < edges_.size(); ++e) {
            for (const uint32_t i : edges_[e]) spacing_[i] = std::min(spacing_[i], length(e));
            const auto steps = static_cast<uint32_t>(2 * length(e) / cells_.size()) + 1;
            for (uint32_t k = 0; k <= steps; ++k) cells_.add(along(e, double(k) / steps), e);
        }
    }

    void run() {
        // Each sample that moves leads to one that stays. Those that nothing leads to follow: so no border shrinks to a point.
        for (const bool is_second : {false, true}) {
            for (uint32_t i = 0; i < role_.size(); ++i) {
                const bool is_free = gluing_.is_shared[i] == 0 && role_[i] == Role::kNone && std::isfinite(spacing_[i]);
                if (!is_free || spacing_[i] < 2 * tolerance_) continue;
                const uint32_t to = nearest(i);
                if (to == kNone || (!is_second && role_[to] == Role::kMoves)) continue;
                role_[i] = Role::kMoves;
                if (role_[to] == Role::kNone) role_[to] = Role::kStays;
                join(i, to);
            }
        }
        for (uint32_t i = 0; i < role_.size(); ++i) {
            if (gluing_.depth[i] != kUndefined) gluing_.origin[i] = first_of(i);
        }
        number_points(gluing_);
    }

  private:
    enum class Role : uint8_t { kNone, kMoves, kStays };

    double length(uint32_t e) const { return (positions_[edges_[e][1]] - positions_[edges_[e][0]]).norm(); }
    Vec3 along(uint32_t e, double t) const { return (1 - t) * positions_[edges_[e][0]] + t * positions_[edges_[e][1]]; }
    double cell_size() const {
        double sum = 0;
        for (uint32_t e = 0; e < edges_.size(); ++e) sum += length(e);
        return std::max(2 * tolerance_, edges_.empty() ? 0 : sum / static_cast<double>(edges_.size()));
    }
    bool are_neighbours(uint32_t a, uint32_t b) const {
        return std::abs(int64_t{a / width_} - int64_t{b / width_}) <= 1 &&
               std::abs(int64_t{a % width_} - int64_t{b % width_}) <= 1;
    }

    // Returns the nearer end of the nearest edge of another border; kNone if there is none within the tolerance.
    uint32_t nearest(uint32_t sample) const {
        const Vec3& p = positions_[sample];
        double least = tolerance_;
        uint32_t best = kNone;
        cells_.for_each_near(p, [&](uint32_t e) {
            const auto [a, b] = edges_[e];
            if (are_neighbours(a, sample) || are_neighbours(b, sample)) return;
            const Vec3 edge = positions_[b] - positions_[a];
            if (edge.squaredNorm() == 0) return;
            const double t = std::clamp((p - positions_[a]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
            const double distance = (p - along(e, t)).norm();
            const uint32_t end = t < 0.5 ? a : b;
            if (distance > least || (distance == least && end >= best)) return;
            least = distance;
            best = end;
        });
        return best;
    }

    uint32_t first_of(uint32_t i) const {
        while (gluing_.origin[i] != i) i = gluing_.origin[i];
        return i;
    }
    void join(uint32_t a, uint32_t b) {
        const uint32_t first = first_of(a), other = first_of(b);
        gluing_.origin[std::max(first, other)] = std::min(first, other);
    }

    uint32_t width_;
    const std::vector<Vec3>& positions_;
    double tolerance_;
    std::vector<Edge> edges_;
    RasterGluing& gluing_;
    std::vector<double> spacing_;  // per sample: of the shortest open edge there
    std::vector<Role> role_;
    CellIndex cells_;  // of edges
};

}  // namespace

void zip_borders(uint32_t width, uint32_t height, std::span<const float> units, const std::vector<Vec3>& positions,
                 double tolerance, RasterGluing& gluing) {
    if (!(tolerance > 0) || gluing.open == 0) return;
    Zipper(width, positions, tolerance, open_edges(width, height, units, gluing), gluing).run();
}

}  // namespace gim

#include "encoder/surface/join_surface.h"

#include <algorithm>
#include <string>
#include <utility>

#include "encoder/base/disjoint_sets.h"
#include "encoder/surface/cut_one_sided.h"
#include "encoder/surface/describe_mesh.h"
#include "encoder/surface/drop_faces.h"

namespace gim {

namespace {

constexpr double kWeldTolerance = 1e-6;  // of the diagonal
constexpr double kMostWelded = 0.1;      // of the diagonal; beyond it, a surface is lost

Error error(std::string message) { return Error{Stage::kClean, std::move(message)}; }

double diagonal_of(const std::vector<Point>& positions) {
    Eigen::AlignedBox3d box;
    for (const Point& p : positions) box.extend(to_vec(p));
    return box.diagonal().norm();
}

// Half-edges that are the only two between the same two vertices, paired.
std::vector<uint32_t> pairs_by_index(const std::vector<Triangle>& triangles, size_t vertices) {
    std::vector<uint32_t> twin(3 * triangles.size(), kNone);
    const EdgeTable edges = build_edge_table(triangles, vertices);
    for (size_t e = 0; e < edges.size(); ++e) {
        const auto around = edges.around(e);
        if (around.size() != 2) continue;
        twin[around[0]] = around[1];
        twin[around[1]] = around[0];
    }
    return twin;
}

// Marks triangles that share no edge with another, as in a soup.
std::vector<uint8_t> find_lone(const std::vector<Triangle>& triangles, size_t vertices) {
    std::vector<uint8_t> is_lone(triangles.size(), 1);
    const std::vector<uint32_t> twin = pairs_by_index(triangles, vertices);
    for (uint32_t h = 0; h < twin.size(); ++h) {
        if (twin[h] != kNone) is_lone[face_of(h)] = 0;
    }
    return is_lone;
}

uint64_t count_open(const FaceJoins& joins) {
    return static_cast<uint64_t>(std::count(joins.twin.begin(), joins.twin.end(), kNone));
}

class Builder {
  public:
    Builder(const TriangleMesh& input, const CleanOptions& options)
        : positions_(input.positions), options_(options), triangles_(input.triangles) {
        const auto by_index = [](const Triangle& t) { return t; };
        const auto any = [](uint32_t) { return true; };
        drop_collapsed(triangles_, by_index, repairs_.degenerate_triangles);
        drop_duplicates(triangles_, by_index, any, repairs_.duplicate_triangles);
        const TopologyAnalysis topology = analyse_topology(triangles_, positions_.size());
        is_manifold_ = topology.nonmanifold_edges.empty() && topology.nonmanifold_vertices.empty();
    }

    Result<JoinedSurface> run() {
        if (triangles_.empty()) return error("every triangle of the mesh repeats a vertex; the surface has no faces");
        std::vector<uint32_t> place = number_places(positions_);
        const double resolution = options_.strict ? 0 : resolution_of(positions_);
        if (resolution > 0) unite_short_edges(positions_, triangles_, resolution, place);
        JoinedSurface surface = join(std::move(place));
        if (options_.strict) GIM_CHECK(refuse_what_is_no_manifold(surface));
        weld_boundaries(surface);
        if (surface.triangles.empty())
            return error("every triangle of the mesh has two corners at one place; the surface has no faces");
        surface.resolution = resolution;
        return surface;
    }

  private:
    JoinedSurface join(std::vector<uint32_t> place) const {
        JoinedSurface surface{triangles_, {}, std::move(place), {}, 0, repairs_};
        const auto at_places = [&](const Triangle& t) {
            return Triangle{surface.place[t[0]], surface.place[t[1]], surface.place[t[2]]};
        };
        drop_collapsed(surface.triangles, at_places, surface.repairs.degenerate_triangles);
        // Where the indices describe a manifold, only lone triangles can be copies.
        const std::vector<uint8_t> is_lone = find_lone(surface.triangles, positions_.size());
        const auto may_go = [&](uint32_t f) { return !is_manifold_ || is_lone[f] != 0; };
        drop_duplicates(surface.triangles, at_places, may_go, surface.repairs.duplicate_triangles);
        const auto join_again = [&] {
            surface.places.clear();
            for (const Triangle& t : surface.triangles) surface.places.push_back(at_places(t));
            std::vector<uint32_t> known;
            if (is_manifold_) known = pairs_by_index(surface.triangles, positions_.size());
            surface.joins = join_faces(positions_, surface.places, known, !options_.strict);
        };
        join_again();
        const std::vector<uint8_t> is_double = find_doubles(surface.places, surface.joins.twin);
        surface.repairs.double_triangles = drop_marked(surface.triangles, is_double);
        if (surface.repairs.double_triangles > 0) join_again();
        return surface;
    }

    // Welds boundary vertices that lie almost at one place, if that closes edges.
    void weld_boundaries(JoinedSurface& surface) const {
        const uint64_t open = count_open(surface.joins);
        const Length wanted = options_.weld_tolerance.value_or(Length{options_.strict ? 0 : kWeldTolerance, true});
        if (open == 0 || !(wanted.value > 0)) return;
        const double diagonal = diagonal_of(positions_);
        const double tolerance = std::min(wanted.value * (wanted.in_diagonals ? diagonal : 1), kMostWelded * diagonal);
        std::vector<uint32_t> candidates;
        for (uint32_t h = 0; h < surface.joins.twin.size(); ++h) {
            if (surface.joins.twin[h] != kNone) continue;
            for (const uint32_t corner : {h, next(h)}) candidates.push_back(surface.triangles[corner / 3][corner % 3]);
        }
        std::vector<uint32_t> place = surface.place;
        const uint64_t welded = unite_near(positions_, candidates, tolerance, place);
        if (welded == 0) return;
        JoinedSurface closer = join(std::move(place));
        if (closer.triangles.empty() || count_open(closer.joins) >= open) return;
        closer.repairs.nearly_welded = welded;
        surface = std::move(closer);
    }

    // Edges of more than two faces are not joined in a strict surface, unless the indices say how.
    Result<void> refuse_what_is_no_manifold(const JoinedSurface& surface) const {
        const Fans fans = number_fans(surface.joins.twin, surface.places, surface.triangles);
        DisjointSets same(positions_.size());
        for (size_t c = 0; c < fans.of_corner.size(); ++c)
            same.unite(surface.triangles[c / 3][c % 3], fans.name[fans.of_corner[c]]);
        std::vector<Triangle> welded = surface.triangles;
        for (Triangle& t : welded) t = {same.find(t[0]), same.find(t[1]), same.find(t[2])};
        const TopologyAnalysis topology = analyse_topology(welded, positions_.size());
        if (topology.summary.nonmanifold_edges + topology.summary.nonmanifold_vertices > 0)
            return error(describe_defects(positions_, welded, topology));
        const Turning turning = find_turning(surface.places, surface.joins.twin);
        if (turning.contradictions.empty()) return {};
        return error(
            "the surface has only one side (like a Moebius strip): no orientation of its faces agrees across " +
            describe_edge(positions_, surface.triangles, turning.contradictions[0]) +
            "; leave out --strict, which cuts it open, or give it thickness");
    }

    const std::vector<Point>& positions_;
    const CleanOptions& options_;
    std::vector<Triangle> triangles_;
    Repairs repairs_;           // of the steps by index
    bool is_manifold_ = false;  // by index
};

}  // namespace

Result<JoinedSurface> join_surface(const TriangleMesh& input, const CleanOptions& options) {
    return Builder(input, options).run();
}

}  // namespace gim

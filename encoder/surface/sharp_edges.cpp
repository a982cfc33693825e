#include "encoder/surface/sharp_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "encoder/base/disjoint_sets.h"
#include "encoder/surface/sharp_lines.h"

namespace gim {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
// Angles between the normals of two faces. A sharp edge begins at one and continues down to the other.
constexpr double kSharp = 40 * kDegree, kStillSharp = 15 * kDegree;
constexpr double kFlat = 1 * kDegree;
// An edge with this angle is sharp also beside others of such angles: those of a box.
constexpr double kCorner = 55 * kDegree;
// The edges beside a sharp one bend the surface by at most this part of its angle; beside one that closes a gap, by this.
constexpr double kBeside = 0.4, kBesideGap = 0.7;
// How far the way to the edges beside leads: edges in all, and edges that are not flat.
constexpr int kMostEdges = 6, kMostBends = 2;
// A line of sharp edges turns by at most this angle where it goes on with a smaller angle between faces.
constexpr double kLeastStraight = 0.5;  // cosine
// Of all edges of a component that are bent so much, at least this part, by length, is sharp in the end. Less is chance.
constexpr double kLeastPart = 0.25;

class SharpEdges {
  public:
    explicit SharpEdges(const Mesh& mesh)
        : mesh_(mesh), topology_(build_topology(mesh)), surfaces_(mesh.positions.size()) {
        for (uint32_t f = 0; f < mesh.triangles.size(); ++f) normals_.push_back(normal_of(f));
        angle_.resize(topology_.twin.size());
        for (uint32_t h = 0; h < angle_.size(); ++h) {
            angle_[h] = angle_at(h);
            surfaces_.unite(from(mesh, h), to(mesh, h));
        }
    }

    std::vector<bool> find() {
        find_strong();
        continue_lines();
        drop_short_lines(mesh_, topology_, sharp_);
        drop_chance();
        return std::move(sharp_);
    }

  private:
    Vec3 normal_of(uint32_t f) const {
        const Triangle& t = mesh_.triangles[f];
        const Vec3& a = mesh_.positions[t[0]];
        return (mesh_.positions[t[1]] - a).cross(mesh_.positions[t[2]] - a).stableNormalized();
    }

    // Boundaries and faces without area count as flat.
    double angle_at(uint32_t h) const {
        if (topology_.twin[h] == kNone) return 0;
        const Vec3 &a = normals_[face_of(h)], &b = normals_[face_of(topology_.twin[h])];
        return std::atan2(a.cross(b).norm(), a.dot(b));
    }

    bool is_owner(uint32_t h) const { return topology_.twin[h] != kNone && h < topology_.twin[h]; }

    // Goes from the middle of an edge straight into its face and on. Returns the largest angle at the next edges.
    double angle_beside(uint32_t h) const;
    bool stands_out(uint32_t h, double part) const {
        const double beside = std::max(angle_beside(h), angle_beside(topology_.twin[h]));
        return beside <= part * angle_[h] || (angle_[h] >= kCorner && beside >= kCorner);
    }

    void mark(uint32_t h) { sharp_[h] = sharp_[topology_.twin[h]] = true; }
    void find_strong();
    void continue_lines();
    void drop_chance();
    double length_of(uint32_t h) const;
    bool continues(uint32_t h, uint32_t vertex) const;

    const Mesh& mesh_;
    Topology topology_;
    std::vector<Vec3> normals_;
    std::vector<double> angle_;  // per half-edge
    std::vector<bool> sharp_;    // per half-edge
    DisjointSets surfaces_;      // of vertices: components
};

double SharpEdges::angle_beside(uint32_t h) const {
    const Vec3 &start = mesh_.positions[from(mesh_, h)], &end = mesh_.positions[to(mesh_, h)];
    Vec3 at = 0.5 * (start + end), way = normals_[face_of(h)].cross(end - start);
    double most = 0;
    int bends = 0;
    for (int i = 0; i < kMostEdges && bends < kMostBends; ++i) {
        // Leaves the face on the side of its opposite corner on which the way passes.
        const uint32_t opposite = prev(h);
        const Vec3 to_corner = mesh_.positions[from(mesh_, opposite)] - at;
        const bool passes_left = way.cross(to_corner).dot(normals_[face_of(h)]) < 0;
        const uint32_t out = passes_left ? opposite : next(h);
        const Vec3 &a = mesh_.positions[from(mesh_, out)], &b = mesh_.positions[to(mesh_, out)];
        const Vec3 along = b - a, across = normals_[face_of(h)].cross(along);
        const double step = way.dot(across);
        if (topology_.twin[out] == kNone || !(std::abs(step) > 0)) break;
        most = std::max(most, angle_[out]);
        bends += angle_[out] > kFlat;
        at += (a - at).dot(across) / step * way;
        // Turns the way into the next face, as if both were flat.
        const double parallel = way.dot(along) / along.squaredNorm();
        const double outwards = -way.dot(across) / across.norm();
        h = topology_.twin[out];
        const Vec3 inwards =
            normals_[face_of(h)].cross(mesh_.positions[to(mesh_, h)] - mesh_.positions[from(mesh_, h)]);
        way = parallel * along + outwards * inwards.stableNormalized();
    }
    return most;
}

void SharpEdges::find_strong() {
    sharp_.assign(angle_.size(), false);
    for (uint32_t h = 0; h < angle_.size(); ++h) {
        if (is_owner(h) && angle_[h] >= kSharp && stands_out(h, kBeside)) mark(h);
    }
}

// Whether an edge goes on straight with a sharp one at the vertex.
bool SharpEdges::continues(uint32_t h, uint32_t vertex) const {
    const uint32_t other = from(mesh_, h) == vertex ? to(mesh_, h) : from(mesh_, h);
    const Vec3 way = (mesh_.positions[other] - mesh_.positions[vertex]).stableNormalized();
    const uint32_t first = topology_.outgoing[vertex];
    uint32_t out = first;
    do {
        const Vec3 back = mesh_.positions[to(mesh_, out)] - mesh_.positions[vertex];
        if (sharp_[out] && way.dot(back.stableNormalized()) < -kLeastStraight) return true;
        out = topology_.twin[prev(out)];
    } while (out != kNone && out != first);
    return false;
}

void SharpEdges::continue_lines() {
    struct Candidate {
        uint32_t half_edge;
        bool is_gap;  // counts if the line goes on at both ends
    };
    std::vector<Candidate> candidates;
    for (uint32_t h = 0; h < angle_.size(); ++h) {
        if (!is_owner(h) || sharp_[h] || angle_[h] < kStillSharp) continue;
        if (stands_out(h, kBeside)) {
            candidates.push_back({h, false});
        } else if (angle_[h] >= kSharp && stands_out(h, kBesideGap)) {
            candidates.push_back({h, true});
        }
    }
    for (bool found = true; found;) {
        found = false;
        std::vector<Candidate> still;
        for (const Candidate& c : candidates) {
            const int ends =
                continues(c.half_edge, from(mesh_, c.half_edge)) + continues(c.half_edge, to(mesh_, c.half_edge));
            if (ends >= (c.is_gap ? 2 : 1)) {
                mark(c.half_edge);
                found = true;
            } else {
                still.push_back(c);
            }
        }
        candidates = std::move(still);
    }
}

double SharpEdges::length_of(uint32_t h) const {
    return (mesh_.positions[to(mesh_, h)] - mesh_.positions[from(mesh_, h)]).norm();
}

void SharpEdges::drop_chance() {
    std::vector<double> bent(mesh_.positions.size()), kept(mesh_.positions.size());
    for (uint32_t h = 0; h < angle_.size(); ++h) {
        if (angle_[h] < kSharp || !is_owner(h)) continue;
        const uint32_t s = surfaces_.find(from(mesh_, h));
        bent[s] += length_of(h);
        if (sharp_[h]) kept[s] += length_of(h);
    }
    for (uint32_t h = 0; h < angle_.size(); ++h) {
        const uint32_t s = surfaces_.find(from(mesh_, h));
        if (kept[s] < kLeastPart * bent[s]) sharp_[h] = false;
    }
}

}  // namespace

std::vector<bool> sharp_edges(const Mesh& mesh) { return SharpEdges(mesh).find(); }

}  // namespace gim

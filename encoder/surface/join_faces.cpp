#include "encoder/surface/join_faces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "encoder/base/disjoint_sets.h"
#include "encoder/surface/signed_sets.h"

namespace gim {

namespace {

// More faces than this at one edge are paired by solid sectors alone, because comparing all pairs takes n^2.
constexpr size_t kMostCompared = 64;
constexpr double kSameAngle = 1e-9;  // radians

// A face at a crowded edge, seen along the edge.
struct Spoke {
    uint32_t half_edge = 0;
    double angle = 0;         // of the third corner around the edge
    bool is_closing = false;  // solid lies before it, at smaller angles
};

class Joiner {
  public:
    Joiner(const std::vector<Point>& positions, const std::vector<Triangle>& triangles, std::span<const uint32_t> known)
        : positions_(positions),
          triangles_(triangles),
          edges_(build_edge_table(triangles, positions.size())),
          sheets_(triangles.size()),
          is_turned_(triangles.size(), 0),
          is_open_(triangles.size(), 0) {
        joins_.twin.assign(3 * triangles.size(), kNone);
        for (uint32_t h = 0; h < known.size(); ++h) {
            if (known[h] != kNone && h < known[h]) join(h, known[h]);
        }
    }

    FaceJoins run(bool pair_crowded) {
        std::vector<uint32_t> crowded;
        std::vector<uint32_t> alone;
        for (uint32_t e = 0; e < edges_.size(); ++e) {
            const std::vector<uint32_t> left = left_at(e);
            if (edges_.around(e).size() > 2) {
                joins_.crowded.push_back(edges_.around(e)[0]);
                if (!left.empty()) crowded.push_back(e);
            } else if (left.size() == 2) {
                join(left[0], left[1]);
            } else if (left.size() == 1) {
                alone.push_back(face_of(left[0]));
            }
        }
        if (crowded.empty() || !pair_crowded) return std::move(joins_);
        choose_sides();
        for (const uint32_t f : alone) is_open_[sheets_.find(f).root] = 1;
        for (const uint32_t e : crowded) pair_by_sectors(spokes_at(e, true));
        for (const uint32_t e : crowded) pair_straight(spokes_at(e, false), false);
        for (const uint32_t e : crowded) pair_straight(spokes_at(e, false), true);
        for (const uint32_t e : crowded) {
            if (const std::vector<uint32_t> left = left_at(e); !left.empty()) joins_.cut.push_back(left[0]);
        }
        return std::move(joins_);
    }

  private:
    uint32_t from(uint32_t h) const { return triangles_[h / 3][h % 3]; }
    bool run_same_way(uint32_t h, uint32_t g) const { return from(h) == from(g); }

    std::vector<uint32_t> left_at(uint32_t e) const {
        std::vector<uint32_t> left;
        for (const uint32_t h : edges_.around(e)) {
            if (joins_.twin[h] == kNone) left.push_back(h);
        }
        return left;
    }

    void join(uint32_t h, uint32_t g) {
        joins_.twin[h] = g;
        joins_.twin[g] = h;
        sheets_.unite(face_of(h), face_of(g), run_same_way(h, g));
    }

    // Turns each sheet to the side that most of its faces show.
    void choose_sides() {
        std::vector<int64_t> excess(triangles_.size(), 0);  // per root: opposite faces minus others
        for (uint32_t f = 0; f < triangles_.size(); ++f) {
            const SignedSets::Place place = sheets_.find(f);
            excess[place.root] += place.is_opposite ? 1 : -1;
        }
        for (uint32_t f = 0; f < triangles_.size(); ++f) {
            const SignedSets::Place place = sheets_.find(f);
            is_turned_[f] = place.is_opposite != (excess[place.root] > 0);
        }
    }

    // The unjoined faces at an edge, by angle. Where two lie on each other, solid ends before solid begins.
    std::vector<Spoke> spokes_at(uint32_t e, bool closed_sheets_only) {
        const std::vector<uint32_t> left = left_at(e);
        std::vector<Spoke> spokes;
        if (left.empty()) return spokes;
        const uint32_t a = std::min(from(left[0]), from(next(left[0])));
        const uint32_t b = std::max(from(left[0]), from(next(left[0])));
        const auto at = [&](uint32_t v) { return to_vec(positions_[v]); };
        const Vec3 axis = (at(b) - at(a)).stableNormalized();
        const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
        for (const uint32_t h : left) {
            const uint32_t f = face_of(h);
            if (closed_sheets_only && is_open_[sheets_.find(f).root]) continue;
            const Vec3 third = (at(from(prev(h))) - at(a)).stableNormalized();
            spokes.push_back({h, std::atan2(third.dot(v), third.dot(u)), (from(h) == a) != (is_turned_[f] != 0)});
        }
        std::sort(spokes.begin(), spokes.end(), [](const Spoke& s, const Spoke& t) {
            return s.angle != t.angle ? s.angle < t.angle : s.half_edge < t.half_edge;
        });
        for (size_t i = 1; i < spokes.size(); ++i) {
            for (size_t k = i; k > 0 && spokes[k].angle - spokes[k - 1].angle < kSameAngle && spokes[k].is_closing &&
                               !spokes[k - 1].is_closing;
                 --k)
                std::swap(spokes[k], spokes[k - 1]);
        }
        return spokes;
    }

    // Joins the two faces of each piece of solid, innermost pieces first.
    void pair_by_sectors(const std::vector<Spoke>& spokes) {
        std::vector<uint32_t> open;
        for (size_t i = 0; i < 2 * spokes.size(); ++i) {
            const Spoke& spoke = spokes[i % spokes.size()];
            if (joins_.twin[spoke.half_edge] != kNone) continue;
            if (!spoke.is_closing) {
                if (i < spokes.size()) open.push_back(spoke.half_edge);
            } else if (!open.empty()) {
                join(open.back(), spoke.half_edge);
                open.pop_back();
            }
        }
    }

    // Joins the straightest pairs first. with_turning: also joins faces that run the same way, if a sheet can be turned.
    void pair_straight(const std::vector<Spoke>& spokes, bool with_turning) {
        if (spokes.size() > kMostCompared) {
            if (!with_turning) pair_by_sectors(spokes);
            return;
        }
        struct Pair {
            double bend;
            size_t first, second;
        };
        std::vector<Pair> pairs;
        for (size_t i = 0; i < spokes.size(); ++i) {
            for (size_t k = i + 1; k < spokes.size(); ++k) {
                if (!with_turning && spokes[i].is_closing == spokes[k].is_closing) continue;
                pairs.push_back({std::abs(std::abs(spokes[i].angle - spokes[k].angle) - std::numbers::pi), i, k});
            }
        }
        std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) { return p.bend < q.bend; });
        for (const Pair& pair : pairs) {
            const uint32_t h = spokes[pair.first].half_edge, g = spokes[pair.second].half_edge;
            if (joins_.twin[h] != kNone || joins_.twin[g] != kNone) continue;
            if (with_turning && !sheets_.unite(face_of(h), face_of(g), run_same_way(h, g))) continue;
            join(h, g);
        }
    }

    const std::vector<Point>& positions_;
    const std::vector<Triangle>& triangles_;
    EdgeTable edges_;
    FaceJoins joins_;
    SignedSets sheets_;               // of faces
    std::vector<uint8_t> is_turned_;  // per face
    std::vector<uint8_t> is_open_;    // per root of `sheets_`: it has an edge of its own that no other face shares
};

}  // namespace

FaceJoins join_faces(const std::vector<Point>& positions, const std::vector<Triangle>& triangles,
                     std::span<const uint32_t> known, bool pair_crowded) {
    return Joiner(positions, triangles, known).run(pair_crowded);
}

Fans number_fans(std::span<const uint32_t> twin, const std::vector<Triangle>& triangles,
                 const std::vector<Triangle>& names) {
    const size_t corners = twin.size();
    DisjointSets same(corners);
    for_each_join(twin, triangles, [&](const JoinedCorners& j) {
        same.unite(j.start, j.start_of_twin);
        same.unite(j.end, j.end_of_twin);
    });
    std::vector<uint32_t> least(corners);  // per root
    const auto name = [&](uint32_t corner) { return names[corner / 3][corner % 3]; };
    for (uint32_t c = 0; c < corners; ++c) least[c] = name(c);
    std::vector<uint32_t> roots;
    for (uint32_t c = 0; c < corners; ++c) {
        const uint32_t root = same.find(c);
        least[root] = std::min(least[root], name(c));
        if (root == c) roots.push_back(c);
    }
    std::stable_sort(roots.begin(), roots.end(), [&](uint32_t a, uint32_t b) { return least[a] < least[b]; });
    Fans fans{std::vector<uint32_t>(corners), {}};
    for (const uint32_t root : roots) {
        fans.of_corner[root] = static_cast<uint32_t>(fans.name.size());
        fans.name.push_back(least[root]);
    }
    for (uint32_t c = 0; c < corners; ++c) fans.of_corner[c] = fans.of_corner[same.find(c)];
    return fans;
}

Components joined_components(std::span<const uint32_t> twin) {
    const size_t faces = twin.size() / 3;
    DisjointSets same(faces);
    for (uint32_t h = 0; h < twin.size(); ++h) {
        if (twin[h] != kNone) same.unite(face_of(h), face_of(twin[h]));
    }
    Components components{std::vector<uint32_t>(faces), 0};
    for (uint32_t f = 0; f < faces; ++f) {
        const uint32_t root = same.find(f);
        components.of_face[f] = root == f ? components.count++ : components.of_face[root];
    }
    return components;
}

}  // namespace gim

#include "encoder/surface/flip_slivers.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace gim {

namespace {

constexpr size_t kListed = 3;
constexpr size_t kMostTries = 8;  // per sliver, those that flips make included

uint64_t key_of(uint32_t a, uint32_t b) { return (uint64_t{std::min(a, b)} << 32) | std::max(a, b); }

class Flipper {
  public:
    Flipper(Mesh& mesh, double thickness)
        : mesh_(mesh), thickness_(thickness), topology_(build_topology(mesh)), is_dropped_(mesh.triangles.size(), 0) {}

    SliverCounts run() {
        std::vector<uint32_t> waiting;
        for (uint32_t f = 0; f < mesh_.triangles.size(); ++f) {
            if (is_sliver(f)) waiting.push_back(f);
        }
        if (waiting.empty()) return {};
        for (uint32_t h = 0; h < topology_.twin.size(); ++h) edges_.insert(key_of(from(mesh_, h), to(mesh_, h)));
        size_t tries = kMostTries * waiting.size();
        std::reverse(waiting.begin(), waiting.end());
        while (!waiting.empty() && tries-- > 0) {
            const uint32_t f = waiting.back();
            waiting.pop_back();
            if (is_dropped_[f] || !is_sliver(f)) continue;
            const uint32_t h = longest_edge(f), g = topology_.twin[h];
            if (g == kNone) {
                note(h);
                ++counts_.dropped;
                drop(f);
            } else if (try_flip(h, g)) {
                ++counts_.flipped;
                waiting.push_back(face_of(g));
                waiting.push_back(f);
            }
        }
        keep_the_rest();
        return std::move(counts_);
    }

  private:
    const Vec3& at(uint32_t v) const { return mesh_.positions[v]; }

    double height(uint32_t a, uint32_t b, uint32_t c) const {
        const Vec3 ab = at(b) - at(a), ac = at(c) - at(a), bc = at(c) - at(b);
        const double longest = std::max({ab.norm(), ac.norm(), bc.norm()});
        return longest > 0 ? ab.cross(ac).norm() / longest : 0;
    }
    double height(uint32_t f) const {
        const Triangle& t = mesh_.triangles[f];
        return height(t[0], t[1], t[2]);
    }
    bool is_sliver(uint32_t f) const { return height(f) <= thickness_; }

    uint32_t longest_edge(uint32_t f) const {
        uint32_t longest = 3 * f;
        double most = -1;
        for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
            const double length = (at(to(mesh_, h)) - at(from(mesh_, h))).squaredNorm();
            if (length > most) {
                most = length;
                longest = h;
            }
        }
        return longest;
    }

    void note(uint32_t h) {
        if (counts_.vertices.size() < kListed) counts_.vertices.push_back(from(mesh_, prev(h)));
    }

    void pair(uint32_t h, uint32_t g) {
        topology_.twin[h] = g;
        if (g != kNone) topology_.twin[g] = h;
    }

    void drop(uint32_t f) {
        is_dropped_[f] = 1;
        for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
            if (topology_.twin[h] == kNone) {
                edges_.erase(key_of(from(mesh_, h), to(mesh_, h)));
            } else {
                topology_.twin[topology_.twin[h]] = kNone;
            }
        }
    }

    // h: a -> c of the sliver (apex b); g: c -> a of its neighbour (apex d). They become (a, d, b) and (d, c, b).
    bool try_flip(uint32_t h, uint32_t g) {
        const uint32_t a = from(mesh_, h), c = to(mesh_, h), b = from(mesh_, prev(h)), d = from(mesh_, prev(g));
        if (b == d || edges_.count(key_of(b, d)) != 0) return false;
        const double before = std::min(height(a, c, b), height(c, a, d));
        if (!(std::min(height(a, d, b), height(d, c, b)) > before)) return false;
        const Vec3 normal = (at(a) - at(c)).cross(at(d) - at(c));
        if ((at(d) - at(a)).cross(at(b) - at(a)).dot(normal) < 0) return false;
        if ((at(c) - at(d)).cross(at(b) - at(d)).dot(normal) < 0) return false;
        const uint32_t f = face_of(h), n = face_of(g);
        const uint32_t cb = topology_.twin[next(h)], ba = topology_.twin[prev(h)];
        const uint32_t ad = topology_.twin[next(g)], dc = topology_.twin[prev(g)];
        note(h);
        edges_.erase(key_of(a, c));
        edges_.insert(key_of(b, d));
        mesh_.triangles[f] = {a, d, b};
        mesh_.triangles[n] = {d, c, b};
        pair(3 * f, ad);
        pair(3 * f + 1, 3 * n + 2);
        pair(3 * f + 2, ba);
        pair(3 * n, dc);
        pair(3 * n + 1, cb);
        return true;
    }

    void keep_the_rest() {
        size_t kept = 0;
        for (uint32_t f = 0; f < mesh_.triangles.size(); ++f) {
            if (is_dropped_[f]) continue;
            counts_.left += is_sliver(f) ? 1 : 0;
            mesh_.triangles[kept++] = mesh_.triangles[f];
        }
        mesh_.triangles.resize(kept);
    }

    Mesh& mesh_;
    double thickness_;
    Topology topology_;
    std::vector<uint8_t> is_dropped_;
    std::unordered_set<uint64_t> edges_;
    SliverCounts counts_;
};

}  // namespace

SliverCounts flip_slivers(Mesh& mesh, double thickness) { return Flipper(mesh, thickness).run(); }

}  // namespace gim

#include "encoder/surface/refine.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>
#include <utility>

namespace gim {

namespace {

class Refiner {
  public:
    explicit Refiner(Mesh mesh) : mesh_(std::move(mesh)), twin_(build_topology(mesh_).twin) {}

    // Splits faces until too_large(mesh, face, its longest half-edge) is false for all of them.
    template <class TooLarge>
    Mesh run(const TooLarge& too_large) {
        // The list grows as faces are split, so the new faces are visited too.
        for (uint32_t f = 0; f < mesh_.triangles.size(); ++f) {
            while (too_large(mesh_, f, longest_edge(f))) split_longest(f);
        }
        return std::move(mesh_);
    }

  private:
    // Splits the longest edge of f. If a neighbour has a longer edge, that one is split first. Edges grow on the way,
    // so the walk ends at an edge that is the longest of both its faces.
    void split_longest(uint32_t f) {
        for (uint32_t at = f;;) {
            const uint32_t h = longest_edge(at), t = twin_[h];
            if (t == kNone || longest_edge(face_of(t)) == t) {
                split_edge(h);
                return;
            }
            at = face_of(t);
        }
    }

    // Ties go by vertex numbers, so that both faces of an edge agree.
    uint32_t longest_edge(uint32_t f) const {
        const auto key = [&](uint32_t e) {
            const uint32_t a = from(mesh_, e), b = to(mesh_, e);
            return std::tuple((mesh_.positions[b] - mesh_.positions[a]).squaredNorm(), std::min(a, b), std::max(a, b));
        };
        uint32_t best = 3 * f;
        for (const uint32_t e : {3 * f + 1, 3 * f + 2}) {
            if (key(e) > key(best)) best = e;
        }
        return best;
    }

    void split_edge(uint32_t h) {
        const uint32_t a = from(mesh_, h), b = to(mesh_, h), t = twin_[h];
        const auto middle = static_cast<uint32_t>(mesh_.positions.size());
        // The smaller number comes first, so that both sides give the same point.
        const Vec3 &p = mesh_.positions[std::min(a, b)], &q = mesh_.positions[std::max(a, b)];
        const Vec3 point = 0.5 * (p + q);
        mesh_.positions.push_back(point);
        const uint32_t rest = split_face(h, middle);
        if (t == kNone) return;
        const uint32_t other_rest = split_face(t, middle);
        pair(h, other_rest);
        pair(t, rest);
    }

    // Face (a, b, c) of h = a->b becomes (a, middle, c); the new face is (middle, b, c). Returns the half-edge
    // middle->b.
    uint32_t split_face(uint32_t h, uint32_t middle) {
        const auto g = static_cast<uint32_t>(mesh_.triangles.size());
        const uint32_t n = next(h);
        mesh_.triangles.push_back({middle, from(mesh_, n), to(mesh_, n)});
        mesh_.triangles[face_of(h)][n % 3] = middle;
        twin_.insert(twin_.end(), {kNone, kNone, kNone});
        pair(3 * g + 1, twin_[n]);
        pair(n, 3 * g + 2);
        return 3 * g;
    }

    void pair(uint32_t h, uint32_t t) {
        twin_[h] = t;
        if (t != kNone) twin_[t] = h;
    }

    Mesh mesh_;
    std::vector<uint32_t> twin_;
};

}  // namespace

Mesh refine_large_faces(Mesh mesh, double largest) {
    return Refiner(std::move(mesh)).run([&](const Mesh& m, uint32_t f, uint32_t) { return face_area(m, f) > largest; });
}

Mesh refine_long_edges(Mesh mesh, double longest) {
    return Refiner(std::move(mesh)).run([&](const Mesh& m, uint32_t, uint32_t h) {
        return (m.positions[to(m, h)] - m.positions[from(m, h)]).norm() > longest;
    });
}

double surface_area(const Mesh& mesh) {
    double area = 0;
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) area += face_area(mesh, f);
    return area;
}

}  // namespace gim

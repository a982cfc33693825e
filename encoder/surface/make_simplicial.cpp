#include "encoder/surface/make_simplicial.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <utility>

#include "encoder/surface/topology_summary.h"

namespace gim {

namespace {

class Splitter {
  public:
    Splitter(Mesh& mesh, std::vector<uint32_t>& twin, std::vector<uint32_t>& origin)
        : mesh_(mesh), twin_(twin), origin_(origin) {}

    // Splits at most one edge of a face, because this renames its other edges. Returns whether doubles are left.
    bool split_edges() {
        const EdgeTable edges = build_edge_table(mesh_.triangles, mesh_.positions.size());
        std::vector<uint8_t> is_touched(mesh_.triangles.size(), 0);
        const auto is_free_face = [&](uint32_t f) { return f < is_touched.size() && !is_touched[f]; };  // no new face
        bool is_left = false;
        for (uint32_t e = 0; e < edges.size(); ++e) {
            const auto around = edges.around(e);
            for (const uint32_t h : around.subspan(1)) {
                const uint32_t g = twin_[h];
                if (g == around[0] || (g != kNone && g < h)) continue;
                const bool is_free = is_free_face(face_of(h)) && (g == kNone || is_free_face(face_of(g)));
                is_left = is_left || !is_free;
                if (!is_free) continue;
                is_touched[face_of(h)] = 1;
                if (g != kNone) is_touched[face_of(g)] = 1;
                split_edge(h);
            }
        }
        return is_left;
    }

    void split_faces() {
        std::vector<std::pair<Triangle, uint32_t>> keys;
        for (uint32_t f = 0; f < mesh_.triangles.size(); ++f) {
            Triangle t = mesh_.triangles[f];
            std::sort(t.begin(), t.end());
            keys.emplace_back(t, f);
        }
        tbb::parallel_sort(keys.begin(), keys.end());
        for (size_t k = 1; k < keys.size(); ++k) {
            if (keys[k].first == keys[k - 1].first) split_face(keys[k].second);
        }
    }

  private:
    uint32_t add_vertex(const Vec3& position, uint32_t origin) {
        mesh_.positions.push_back(position);
        origin_.push_back(origin);
        return static_cast<uint32_t>(mesh_.positions.size() - 1);
    }

    void pair(uint32_t h, uint32_t g) {
        twin_[h] = g;
        if (g != kNone) twin_[g] = h;
    }

    // Returns the first half-edge of a new face.
    uint32_t add_face(const Triangle& t) {
        mesh_.triangles.push_back(t);
        twin_.resize(twin_.size() + 3, kNone);
        return static_cast<uint32_t>(twin_.size() - 3);
    }

    // Cuts the face of h in two at m on its edge. h keeps the first half. Returns the half-edge of the second half.
    uint32_t cut_face(uint32_t h, uint32_t m) {
        const uint32_t end = to(mesh_, h), apex = from(mesh_, prev(h));
        const uint32_t outer = twin_[next(h)];
        mesh_.triangles[h / 3][(h % 3 + 1) % 3] = m;
        const uint32_t second = add_face({m, end, apex});
        pair(second + 1, outer);
        pair(second + 2, next(h));
        return second;
    }

    void split_edge(uint32_t h) {
        const uint32_t g = twin_[h], a = from(mesh_, h), b = to(mesh_, h);
        const uint32_t m = add_vertex((mesh_.positions[a] + mesh_.positions[b]) / 2, origin_[a]);
        const uint32_t h_end = cut_face(h, m);
        if (g == kNone) {
            twin_[h_end] = kNone;
            return;
        }
        const uint32_t g_end = cut_face(g, m);
        pair(h, g_end);
        pair(h_end, g);
    }

    void split_face(uint32_t f) {
        const Triangle t = mesh_.triangles[f];
        const Vec3 middle = (mesh_.positions[t[0]] + mesh_.positions[t[1]] + mesh_.positions[t[2]]) / 3;
        const uint32_t m = add_vertex(middle, origin_[t[0]]);
        const uint32_t outer1 = twin_[3 * f + 1], outer2 = twin_[3 * f + 2];
        mesh_.triangles[f][2] = m;
        const uint32_t second = add_face({t[1], t[2], m}), third = add_face({t[2], t[0], m});
        pair(second, outer1);
        pair(third, outer2);
        pair(3 * f + 1, second + 2);
        pair(second + 1, third + 2);
        pair(third + 1, 3 * f + 2);
    }

    Mesh& mesh_;
    std::vector<uint32_t>& twin_;
    std::vector<uint32_t>& origin_;
};

}  // namespace

uint64_t make_simplicial(Mesh& mesh, std::vector<uint32_t>& twin, std::vector<uint32_t>& origin) {
    const size_t before = mesh.positions.size();
    Splitter splitter(mesh, twin, origin);
    while (splitter.split_edges()) {
    }
    splitter.split_faces();
    return mesh.positions.size() - before;
}

}  // namespace gim

// Undoes the collapses of a base mesh, written apart from the encoder's own code.
#pragma once

#include <algorithm>
#include <vector>

#include "encoder/tiles/base_mesh.h"

namespace gim {

// Each triangle from its smallest vertex on, sorted.
inline std::vector<Triangle> normal_form(std::vector<Triangle> triangles) {
    for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

class BaseUndo {
  public:
    BaseUndo(const BaseMesh& base, size_t vertices) : triangles_(base.triangles), at_(vertices) {
        for (uint32_t f = 0; f < triangles_.size(); ++f) {
            for (const uint32_t v : triangles_[f]) at_[v].push_back(f);
        }
    }

    // Returns whether the faces around `into` run from left to right.
    bool undo(const HalfEdgeCollapse& c) {
        // The faces of `vertex` lie counter-clockwise from left to right around `into`.
        if (c.left != kNone) {
            for (uint32_t at = c.left; at != c.right;) {
                const uint32_t f = face(c.into, at, true);
                if (f == kNone) return c.right == kNone && add(c);
                at = give(f, c, at, true);
            }
        } else {
            for (uint32_t at = c.right;;) {
                const uint32_t f = face(c.into, at, false);
                if (f == kNone) break;
                at = give(f, c, at, false);
            }
        }
        return add(c);
    }

    const std::vector<Triangle>& triangles() const { return triangles_; }

  private:
    static uint32_t corner_after(const Triangle& t, uint32_t v, size_t steps) {
        return t[(static_cast<size_t>(std::find(t.begin(), t.end(), v) - t.begin()) + steps) % 3];
    }
    // The face at v whose corner after v (or before it) is w.
    uint32_t face(uint32_t v, uint32_t w, bool after) const {
        for (const uint32_t f : at_[v]) {
            if (corner_after(triangles_[f], v, after ? 1 : 2) == w) return f;
        }
        return kNone;
    }
    // Gives a face of `into` to `vertex`. Returns its third corner.
    uint32_t give(uint32_t f, const HalfEdgeCollapse& c, uint32_t at, bool after) {
        const uint32_t third = corner_after(triangles_[f], at, after ? 1 : 2);
        *std::find(triangles_[f].begin(), triangles_[f].end(), c.into) = c.vertex;
        std::erase(at_[c.into], f);
        at_[c.vertex].push_back(f);
        return third;
    }
    bool add(const HalfEdgeCollapse& c) {
        if (c.left != kNone) add_face({c.vertex, c.into, c.left});
        if (c.right != kNone) add_face({c.into, c.vertex, c.right});
        return true;
    }
    void add_face(const Triangle& t) {
        for (const uint32_t v : t) at_[v].push_back(static_cast<uint32_t>(triangles_.size()));
        triangles_.push_back(t);
    }

    std::vector<Triangle> triangles_;
    std::vector<std::vector<uint32_t>> at_;  // per vertex its faces
};

}  // namespace gim

// A triangle mesh laid out on the flat surface of the tiles, refined by undoing half-edge collapses.
//
// The unit squares glued along their sides are a flat surface with cones at the base vertices. All base vertices are
// vertices of the mesh, so no triangle has a cone inside, and each triangle lies in a plane: it has a frame, in which
// its three corners have places. Neighbours agree on the length of their edge exactly. The star of a vertex that is no
// cone unfolds into the plane. As long as the vertex moves inside the star's kernel, the map stays one to one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"
#include "encoder/tiles/base_mesh.h"
#include "encoder/tiles/tile_walk.h"

namespace gim {

struct FlatFace {
    std::array<Vec2, 3> place;  // of the corners, in the frame of `tile`; multiples of kGrid
    uint32_t tile = 0;          // contains the centroid
};

// A face around a vertex, unfolded. Places count from the vertex, in the frame of the first face of the star.
struct Spoke {
    uint32_t half_edge = 0;  // leaves the vertex
    uint32_t quarters = 0;   // turn from the frame of the face into that of the star
    Vec2 p1, p2;             // the other two corners, counter-clockwise
};

class FlatMesh {
  public:
    // Vertices are numbered below vertex_count; those without a face are not present. The walker must outlive this.
    FlatMesh(const std::vector<Triangle>& triangles, std::vector<FlatFace> faces, uint32_t vertex_count,
             const TileWalker& walker);

    uint32_t face_count() const { return static_cast<uint32_t>(faces_.size()); }
    uint32_t vertex_count() const { return static_cast<uint32_t>(outgoing_.size()); }
    uint32_t origin(uint32_t h) const { return origin_[h]; }
    uint32_t target(uint32_t h) const { return origin_[next(h)]; }
    uint32_t twin(uint32_t h) const { return twin_[h]; }
    Triangle triangle(uint32_t f) const { return {origin_[3 * f], origin_[3 * f + 1], origin_[3 * f + 2]}; }
    const TileWalker& walker() const { return walker_; }
    const FlatFace& face(uint32_t f) const { return faces_[f]; }
    bool present(uint32_t v) const { return outgoing_[v] != kNone; }
    bool on_boundary(uint32_t v) const { return twin_[outgoing_[v]] == kNone; }
    // The half-edge from v to w, or kNone.
    uint32_t half_edge_between(uint32_t v, uint32_t w) const;
    const Vec2& place(uint32_t h) const { return faces_[face_of(h)].place[h % 3]; }

    // Sides are edges that lie on tile borders and stay there: creases and boundaries.
    void mark_side(uint32_t h);
    bool is_side(uint32_t h) const { return side_[h] != 0; }

    // Calls visit(h) for every half-edge that leaves v, counter-clockwise; from the boundary on if v is on one.
    template <class Visit>
    void for_each_outgoing(uint32_t v, Visit&& visit) const {
        const uint32_t first = outgoing_[v];
        uint32_t h = first;
        do {
            visit(h);
            h = twin_[prev(h)];
        } while (h != first && h != kNone);
    }

    // Gives the fan of faces around `into` between left and right back to `vertex`, and the two faces between them.
    // `vertex` gets the place of `into`. on_side: whether `vertex` lies on a crease or boundary. ring: what last_ring()
    // returned when the collapse was undone in its turn; empty: anything. Returns false, and changes nothing, if the fan
    // is another one.
    bool split(const HalfEdgeCollapse& collapse, bool on_side, const std::vector<uint32_t>& ring);
    // The neighbours of the last split's vertex.
    const std::vector<uint32_t>& last_ring() const { return undo_.ring; }
    // Returns whether the last split's vertex lies on a side.
    bool last_slides() const { return undo_.slides; }
    // Undoes the last split. The new vertices must not have moved.
    void unsplit();
    // Makes the star of v begin at the half-edge from v to w. Not for vertices on a boundary.
    void begin_star_at(uint32_t v, uint32_t w);

    // Unfolds the star of v. The first spoke's frame is that of its face.
    void unfold(uint32_t v, std::vector<Spoke>& star) const;
    // Moves v by x, in the frame of its star, which must be unfolded. Returns false, and changes nothing, if a face
    // would not certainly stay counter-clockwise. x is rounded to the grid.
    bool move(const std::vector<Spoke>& star, const Vec2& x);
    // Moves v to the place of its neighbour w exactly. Returns false, and changes nothing, if a face besides the two at
    // their edge would not certainly stay counter-clockwise.
    bool move_onto(const std::vector<Spoke>& star, uint32_t w);
    // Gives a face a place that it had before.
    void set_face(uint32_t f, const FlatFace& face) { faces_[f] = face; }
    // Returns the axis along which a vertex on a side may move (0: x, 1: y), in the frame of its star.
    int side_axis(uint32_t v) const;

  private:
    struct Undo {
        HalfEdgeCollapse collapse;
        std::vector<uint32_t> fan;   // half-edges that were handed over
        std::vector<uint32_t> ring;  // their targets
        std::array<uint32_t, 4> edges{}, outgoing{};
        std::array<uint8_t, 2> sides{};
        bool slides = false;
    };
    void pair(uint32_t a, uint32_t b);
    void mark(uint32_t h, bool is_side);
    bool move_exactly(const std::vector<Spoke>& star, const Vec2& step);
    bool find_fan(const HalfEdgeCollapse& collapse);
    uint32_t add_face(const Triangle& corners, uint32_t third, uint32_t shared);
    void remove_faces(size_t count);
    uint8_t insert_face(uint32_t h, uint32_t at_into, uint32_t at_vertex, bool is_ear);
    void restore_outgoing(uint32_t left_face, uint32_t right_face);

    const TileWalker& walker_;
    std::vector<uint32_t> origin_, twin_, outgoing_;
    std::vector<uint8_t> side_;
    std::vector<FlatFace> faces_;
    Undo undo_;
    std::vector<FlatFace> moved_;  // scratch of move()
};

}  // namespace gim

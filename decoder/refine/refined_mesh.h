// A mesh of right triangles over the tiles of an image, as fine as each place needs. The half-edge structure of
// Maximo, Velho, Siqueira 2013, sections 4.3 and 4.4: edge splits refine it, vertex welds undo them, and levels of
// neighbours differ by one at most. After: Velho, Gomes. Variable resolution 4-k meshes. 2000.
//
// Half-edges 3f, 3f+1, 3f+2 belong to triangle f, counter-clockwise seen from outside. 3f is the one that a split halves:
// the paper calls it interior, because it crosses a square of two triangles, and the other two boundary. So the paper's
// marks are the half-edges' numbers, and its rules are: an edge can be split if both of its half-edges are first ones, and
// a vertex can be welded if no half-edge that starts there is a first or second one.
//
// Beyond a plain half-edge, each has the place of its start in its tile (4 bytes) and a third of the tile's number (4
// bytes); where it ends is where the next one starts. That is 5.3 bytes, and 0.7 for how long a triangle may wait; the paper stores 6. A vertex has 1 byte, its level.
#pragma once

#include <cstdint>
#include <span>

#include "decoder/pyramid/arena.h"
#include "decoder/refine/quad_domain.h"
#include "format/container.h"

namespace gim {

inline constexpr uint32_t kNoHalfEdge = UINT32_MAX;
inline constexpr uint8_t kNoVertexLevel = 31;  // the vertex is not in the mesh

struct TilePlace {
    uint16_t row, column;
};

constexpr uint32_t triangle_of(uint32_t half_edge) { return half_edge / 3; }
constexpr uint32_t next_half_edge(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
constexpr uint32_t previous_half_edge(uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

// What differs between the mesh of the last call of take_changes and this one.
struct MeshChanges {
    std::span<const uint32_t> added, removed;  // vertices
    std::span<const uint32_t> triangles;       // numbers below triangle_count whose vertices may differ
    uint32_t triangles_before = 0;
};

class RefinedMesh {
  public:
    // Takes its arrays from the arena, for at most so many triangles. Without memory it only counts.
    RefinedMesh(const QuadDomain* domain, uint32_t most_triangles, Arena* arena);

    // Makes the mesh that of the base: two triangles a tile. Cost: O(vertices of the domain).
    void reset();

    const QuadDomain& domain() const { return *domain_; }
    uint32_t triangle_count() const { return count_; }
    const uint32_t* triangles() const { return vertex_; }  // three vertices each
    uint32_t most_triangles() const { return most_; }

    uint32_t vertex(uint32_t half_edge) const { return vertex_[half_edge]; }
    uint32_t mate(uint32_t half_edge) const { return mate_[half_edge]; }
    uint32_t tile(uint32_t triangle) const { return tile_[triangle]; }
    TilePlace start(uint32_t half_edge) const { return place_[half_edge]; }
    // 0 .. 20, or kNoVertexLevel. Base vertices have 0.
    uint8_t level(uint32_t vertex) const { return level_[vertex] & kLevelBits; }
    uint32_t half_edge_at(uint32_t vertex) const { return half_edge_[vertex]; }  // one that starts there

    // Calls f for the half-edges that start where `start` does, counter-clockwise, from the boundary on if there is one.
    template <class F>
    void for_each_spoke(uint32_t start, const F& f) const {
        uint32_t first = start;
        while (mate_[first] != kNoHalfEdge) {
            first = next_half_edge(mate_[first]);
            if (first == start) break;
        }
        for (uint32_t h = first;;) {
            f(h);
            h = mate_[previous_half_edge(h)];
            if (h == kNoHalfEdge || h == first) break;
        }
    }

    // The vertex that a split of the triangle adds, or kNoHalfEdge if the samples end there.
    uint32_t middle_of(uint32_t triangle) const;

    // Whether the triangle is the one that stands for a split of its first edge: of two triangles that one has a part in it,
    // the other has not.
    bool stands_for_split(uint32_t triangle) const {
        const uint32_t beyond = mate_[3 * triangle];
        return beyond == kNoHalfEdge || beyond % 3 != 0 || beyond > 3 * triangle;
    }
    // The triangle itself, or the coarser one that must be split first so that it can be.
    uint32_t first_to_split(uint32_t triangle) const;
    // How many triangles a split adds, with those that it forces.
    uint32_t triangles_needed(uint32_t triangle) const;

    // Splits the triangle and the one beyond its first half-edge. If that one is coarser, splits it before, and so on.
    // Returns kScratchTooSmall, with the mesh as it was, if the triangles do not suffice; kBadArgument if there is no such
    // triangle or no sample in the middle. Cost: O(1) but for the coarser ones, of which there are at most 20.
    Status split(uint32_t triangle);

    // Removes a vertex whose triangles are those that its split made. Returns whether it is one.
    bool weld(uint32_t vertex);
    bool may_weld(uint32_t vertex) const;

    // A number for each triangle, for who refines. It becomes 0 where a split or weld changes the triangle.
    uint16_t patience(uint32_t triangle) const { return patience_[triangle]; }
    void set_patience(uint32_t triangle, uint16_t patience) { patience_[triangle] = patience; }

    // Valid until the next split or weld. Cost: O(changes).
    MeshChanges take_changes();

  private:
    static constexpr uint8_t kLevelBits = 31, kWasThere = 32, kIsNoted = 64;

    struct Around;  // the triangles at a vertex that can be welded

    // The triangles beyond first half-edges, each coarser than the one before, from `triangle` on. Each must be split before
    // the one before it. Calls f(triangle, number of triangles that its split adds).
    template <class F>
    void for_each_coarser(uint32_t triangle, const F& f) const;
    TilePlace middle_place(uint32_t triangle) const;
    void split_pair(uint32_t triangle);
    void merge_pair(const Around& around);
    Around around(uint32_t vertex) const;
    void set(uint32_t half_edge, uint32_t vertex, TilePlace place) {
        vertex_[half_edge] = vertex;
        place_[half_edge] = place;
        half_edge_[vertex] = half_edge;
    }
    void join(uint32_t a, uint32_t b) {
        mate_[a] = b;
        if (b != kNoHalfEdge) mate_[b] = a;
    }
    void remove_triangle(uint32_t triangle);
    void set_level(uint32_t vertex, uint8_t level);
    void note_triangle(uint32_t triangle);

    const QuadDomain* domain_;
    uint32_t most_, count_ = 0;
    uint32_t *mate_, *vertex_;  // per half-edge
    TilePlace* place_;
    uint32_t* tile_;       // per triangle
    uint32_t* half_edge_;  // per vertex
    uint8_t* level_;       // per vertex, with marks of the changes
    uint8_t* is_noted_;    // per triangle
    uint16_t* patience_;   // per triangle
    uint32_t *triangles_noted_, *vertices_noted_;
    uint32_t triangle_notes_ = 0, vertex_notes_ = 0, count_before_ = 0;
};

}  // namespace gim

#include "decoder/refine/refined_mesh.h"

#include <algorithm>
#include <utility>

namespace gim {

// Counter-clockwise: the triangles that the split made of the first one, then of the second one.
struct RefinedMesh::Around {
    uint32_t count = 0;  // 0: it cannot be welded; 2 on a boundary; else 4
    // Of the triangle (a, b, c) with the vertex in the middle of a b: (c, a, middle) and (b, c, middle).
    uint32_t first[2] = {}, second[2] = {};
};

RefinedMesh::RefinedMesh(const QuadDomain* domain, uint32_t most_triangles, Arena* arena)
    : domain_(domain), most_(most_triangles) {
    const size_t half_edges = size_t{3} * most_, vertices = domain->shape().vertices;
    mate_ = arena->take<uint32_t>(half_edges);
    vertex_ = arena->take<uint32_t>(half_edges);
    place_ = arena->take<TilePlace>(half_edges);
    tile_ = arena->take<uint32_t>(most_);
    half_edge_ = arena->take<uint32_t>(vertices);
    level_ = arena->take<uint8_t>(vertices);
    is_noted_ = arena->take<uint8_t>(most_);
    patience_ = arena->take<uint16_t>(most_);
    triangles_noted_ = arena->take<uint32_t>(most_);
    vertices_noted_ = arena->take<uint32_t>(vertices);
}

void RefinedMesh::reset() {
    const DomainShape& shape = domain_->shape();
    const TileGlue& glue = domain_->glue();
    const auto n = static_cast<uint16_t>(shape.intervals);
    const TilePlace corners[4] = {{0, 0}, {0, n}, {n, n}, {n, 0}};
    std::fill_n(level_, shape.vertices, kNoVertexLevel);
    std::fill_n(half_edge_, shape.vertices, kNoHalfEdge);
    std::fill_n(is_noted_, most_, uint8_t{0});
    count_ = 2 * shape.tiles;
    triangle_notes_ = vertex_notes_ = count_before_ = 0;
    // Side i of a tile: triangle and place among its half-edges, if the diagonal is not anti, and if it is.
    constexpr uint32_t kSide[2][4] = {{1, 2, 4, 5}, {5, 1, 2, 4}};
    const auto half_edge_of = [&](uint32_t side) {
        return 6 * tile_of(side) + kSide[glue.is_anti[tile_of(side)]][side_of(side)];
    };
    for (uint32_t t = 0; t < shape.tiles; ++t) {
        // Corners of the triangles, the one where the diagonal starts first.
        const uint32_t turn = glue.is_anti[t] ? 1 : 0;
        const uint32_t of_triangle[6] = {2, 0, 1, 0, 2, 3};
        tile_[2 * t] = tile_[2 * t + 1] = t;
        for (uint32_t i = 0; i < 6; ++i) {
            const uint32_t corner = (of_triangle[i] + turn) % 4;
            set(6 * t + i, glue.corner[4 * t + corner], corners[corner]);
            mate_[6 * t + i] = kNoHalfEdge;
        }
        join(6 * t, 6 * t + 3);
    }
    for (uint32_t side = 0; side < 4 * shape.tiles; ++side) {
        if (glue.mate[side] != kNoMate) mate_[half_edge_of(side)] = half_edge_of(glue.mate[side]);
        set_level(glue.corner[side], 0);
    }
    for (uint32_t f = 0; f < count_; ++f) note_triangle(f);
}

TilePlace RefinedMesh::middle_place(uint32_t triangle) const {
    const TilePlace a = place_[3 * triangle], b = place_[3 * triangle + 1];
    return {static_cast<uint16_t>((a.row + b.row) / 2), static_cast<uint16_t>((a.column + b.column) / 2)};
}

uint32_t RefinedMesh::middle_of(uint32_t triangle) const {
    const TilePlace a = place_[3 * triangle], b = place_[3 * triangle + 1];
    if (((a.row + b.row) | (a.column + b.column)) & 1) return kNoHalfEdge;
    return domain_->vertex_at(tile_[triangle], (a.row + b.row) / 2u, (a.column + b.column) / 2u);
}

template <class F>
void RefinedMesh::for_each_coarser(uint32_t triangle, const F& f) const {
    for (;;) {
        const uint32_t beyond = mate_[3 * triangle];
        f(triangle, beyond == kNoHalfEdge ? 1u : 2u);
        if (beyond == kNoHalfEdge || beyond % 3 == 0) break;
        triangle = triangle_of(beyond);
    }
}

uint32_t RefinedMesh::first_to_split(uint32_t triangle) const {
    uint32_t first = triangle;
    for_each_coarser(triangle, [&](uint32_t f, uint32_t) { first = f; });
    return first;
}

uint32_t RefinedMesh::triangles_needed(uint32_t triangle) const {
    uint32_t needed = 0;
    for_each_coarser(triangle, [&](uint32_t, uint32_t added) { needed += added; });
    return needed;
}

Status RefinedMesh::split(uint32_t triangle) {
    if (triangle >= count_ || middle_of(triangle) == kNoHalfEdge) return Status::kBadArgument;
    if (triangles_needed(triangle) > most_ - count_) return Status::kScratchTooSmall;
    for (;;) {
        const uint32_t first = first_to_split(triangle);
        split_pair(first);
        if (first == triangle) return Status::kOk;
    }
}

// The first half-edge of f has no mate, or one that is a first half-edge too.
void RefinedMesh::split_pair(uint32_t f) {
    const uint32_t beyond = mate_[3 * f], middle = middle_of(f);
    const bool is_pair = beyond != kNoHalfEdge;
    const uint32_t g = is_pair ? triangle_of(beyond) : 0;
    const uint32_t f2 = count_, g2 = count_ + 1;
    count_ += is_pair ? 2 : 1;
    const auto level = static_cast<uint8_t>(level_[vertex_[3 * f + 2]] & kLevelBits);
    set_level(middle, static_cast<uint8_t>(level + 1));

    // The mates of the four half-edges that become first ones, under their new numbers.
    const auto moved = [&](uint32_t h) {
        if (h == 3 * f + 1) return 3 * f2;
        if (h == 3 * f + 2) return 3 * f;
        if (is_pair && h == 3 * g + 1) return 3 * g2;
        if (is_pair && h == 3 * g + 2) return 3 * g;
        return h;
    };
    const uint32_t f_first = moved(mate_[3 * f + 2]), f2_first = moved(mate_[3 * f + 1]);
    const uint32_t g_first = is_pair ? moved(mate_[3 * g + 2]) : kNoHalfEdge;
    const uint32_t g2_first = is_pair ? moved(mate_[3 * g + 1]) : kNoHalfEdge;

    // (a, b, c) becomes (c, a, middle) and (b, c, middle).
    const auto halve = [&](uint32_t old, uint32_t added) {
        const TilePlace m = middle_place(old);
        uint32_t v[3];
        TilePlace p[3];
        for (uint32_t i = 0; i < 3; ++i) v[i] = vertex_[3 * old + i], p[i] = place_[3 * old + i];
        tile_[added] = tile_[old];
        set(3 * old, v[2], p[2]);
        set(3 * old + 1, v[0], p[0]);
        set(3 * old + 2, middle, m);
        set(3 * added, v[1], p[1]);
        set(3 * added + 1, v[2], p[2]);
        set(3 * added + 2, middle, m);
        join(3 * old + 2, 3 * added + 1);
        note_triangle(old);
        note_triangle(added);
    };
    halve(f, f2);
    join(3 * f, f_first);
    join(3 * f2, f2_first);
    if (!is_pair) {
        mate_[3 * f + 1] = mate_[3 * f2 + 2] = kNoHalfEdge;
        return;
    }
    halve(g, g2);
    join(3 * g, g_first);
    join(3 * g2, g2_first);
    join(3 * f + 1, 3 * g2 + 2);  // a to the middle
    join(3 * f2 + 2, 3 * g + 1);  // the middle to b
}

RefinedMesh::Around RefinedMesh::around(uint32_t vertex) const {
    const uint8_t level = level_[vertex] & kLevelBits;
    if (level == 0 || level == kNoVertexLevel) return {};
    // The half-edges that start there, counter-clockwise; all must be third ones. On a boundary from its start.
    uint32_t start = half_edge_[vertex];
    for (uint32_t i = 0; i < 4; ++i) {
        if (start % 3 != 2) return {};
        const uint32_t before = mate_[start];
        if (before == kNoHalfEdge || i == 3) break;
        start = next_half_edge(before);
        if (start == half_edge_[vertex]) break;
    }
    uint32_t spokes[4], count = 0;
    for (uint32_t h = start;;) {
        if (count == 4 || h % 3 != 2) return {};
        spokes[count++] = h;
        h = mate_[previous_half_edge(h)];
        if (h == kNoHalfEdge || h == start) break;
    }
    if (count != 2 && count != 4) return {};
    // The split that made the vertex was at the third vertex c of its triangles: that one came last but for this one. In
    // the base all four have level 0; there the diagonal tells.
    const auto is_split_from = [&](uint32_t spoke) {
        const uint32_t f = triangle_of(spoke), c = vertex_[3 * f];
        if (level > 1) return (level_[c] & kLevelBits) + 1 == level;
        const TilePlace p = place_[3 * f];
        return ((p.row == 0) == (p.column == 0)) == (domain_->glue().is_anti[tile_[f]] != 0);
    };
    // Spoke k goes to the end of the first half-edge's start: triangle k is (start, end, middle).
    const uint32_t first = is_split_from(spokes[0]) ? 0 : 1;
    Around result;
    const auto f_at = [&](uint32_t k) { return triangle_of(spokes[k % count]); };
    if (count == 2) {
        // (b, c, middle) comes before (c, a, middle).
        result.first[0] = f_at(1), result.first[1] = f_at(0);
    } else {
        result.first[0] = f_at(first), result.first[1] = f_at(first + 3);
        result.second[0] = f_at(first + 2), result.second[1] = f_at(first + 1);
    }
    result.count = count;
    return result;
}

bool RefinedMesh::may_weld(uint32_t vertex) const { return around(vertex).count != 0; }

bool RefinedMesh::weld(uint32_t vertex) {
    if (vertex >= domain_->shape().vertices) return false;
    const Around at = around(vertex);
    if (at.count == 0) return false;
    merge_pair(at);
    half_edge_[vertex] = kNoHalfEdge;
    set_level(vertex, kNoVertexLevel);
    return true;
}

void RefinedMesh::merge_pair(const Around& at) {
    const bool is_pair = at.count == 4;
    const uint32_t f = at.first[0], f2 = at.first[1], g = at.second[0], g2 = at.second[1];
    const auto moved = [&](uint32_t h) {
        if (h == 3 * f) return 3 * f + 2;
        if (h == 3 * f2) return 3 * f + 1;
        if (is_pair && h == 3 * g) return 3 * g + 2;
        if (is_pair && h == 3 * g2) return 3 * g + 1;
        return h;
    };
    const uint32_t f_third = moved(mate_[3 * f]), f_second = moved(mate_[3 * f2]);
    const uint32_t g_third = is_pair ? moved(mate_[3 * g]) : kNoHalfEdge;
    const uint32_t g_second = is_pair ? moved(mate_[3 * g2]) : kNoHalfEdge;
    // (c, a, middle) and (b, c, middle) become (a, b, c).
    const auto unite = [&](uint32_t kept, uint32_t other) {
        const uint32_t a = 3 * kept + 1, b = 3 * other, c = 3 * kept;
        const uint32_t v[3] = {vertex_[a], vertex_[b], vertex_[c]};
        const TilePlace p[3] = {place_[a], place_[b], place_[c]};
        for (uint32_t i = 0; i < 3; ++i) set(3 * kept + i, v[i], p[i]);
        note_triangle(kept);
    };
    unite(f, f2);
    join(3 * f + 1, f_second);
    join(3 * f + 2, f_third);
    mate_[3 * f] = kNoHalfEdge;
    if (is_pair) {
        unite(g, g2);
        join(3 * g + 1, g_second);
        join(3 * g + 2, g_third);
        join(3 * f, 3 * g);
        remove_triangle(std::max(f2, g2));
        remove_triangle(std::min(f2, g2));
    } else {
        remove_triangle(f2);
    }
}

// The last triangle takes its place.
void RefinedMesh::remove_triangle(uint32_t f) {
    const uint32_t last = --count_;
    if (f == last) return;
    tile_[f] = tile_[last];
    for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t from = 3 * last + i, to = 3 * f + i;
        const uint32_t beyond = mate_[from];
        vertex_[to] = vertex_[from];
        place_[to] = place_[from];
        if (half_edge_[vertex_[to]] == from) half_edge_[vertex_[to]] = to;
        if (beyond != kNoHalfEdge && triangle_of(beyond) == last) {
            mate_[to] = 3 * f + beyond % 3;  // both sides of the edge are the triangle's own
        } else {
            join(to, beyond);
        }
    }
    note_triangle(f);
}

void RefinedMesh::set_level(uint32_t vertex, uint8_t level) {
    uint8_t& now = level_[vertex];
    if (!(now & kIsNoted)) {
        const bool was_there = (now & kLevelBits) != kNoVertexLevel;
        now = static_cast<uint8_t>(now | kIsNoted | (was_there ? kWasThere : 0));
        vertices_noted_[vertex_notes_++] = vertex;
    }
    now = static_cast<uint8_t>((now & ~kLevelBits) | level);
}

void RefinedMesh::note_triangle(uint32_t triangle) {
    patience_[triangle] = 0;
    if (is_noted_[triangle]) return;
    is_noted_[triangle] = 1;
    triangles_noted_[triangle_notes_++] = triangle;
}

MeshChanges RefinedMesh::take_changes() {
    // Added vertices to the front, removed ones behind them; the others are as they were.
    uint32_t* const notes = vertices_noted_;
    uint32_t added = 0;
    const auto is_there = [&](uint32_t v) { return (level_[v] & kLevelBits) != kNoVertexLevel; };
    for (uint32_t i = 0; i < vertex_notes_; ++i) {
        if (is_there(notes[i]) && !(level_[notes[i]] & kWasThere)) std::swap(notes[added++], notes[i]);
    }
    uint32_t end = added;
    for (uint32_t i = added; i < vertex_notes_; ++i) {
        if (!is_there(notes[i]) && (level_[notes[i]] & kWasThere)) std::swap(notes[end++], notes[i]);
    }
    for (uint32_t i = 0; i < vertex_notes_; ++i) level_[notes[i]] &= kLevelBits;
    vertex_notes_ = 0;

    uint32_t kept = 0;
    for (uint32_t i = 0; i < triangle_notes_; ++i) {
        const uint32_t f = triangles_noted_[i];
        is_noted_[f] = 0;
        if (f < count_) triangles_noted_[kept++] = f;
    }
    triangle_notes_ = 0;
    const uint32_t before = std::exchange(count_before_, count_);
    return {{notes, added}, {notes + added, end - added}, {triangles_noted_, kept}, before};
}

}  // namespace gim

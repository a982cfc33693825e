#include "encoder/tiles/flat_mesh.h"

#include <algorithm>
#include <cmath>

#include "encoder/surface/stretch.h"

namespace gim {

namespace {

Vec2 to_grid(const Vec2& x) { return {std::round(x.x() / kGrid) * kGrid, std::round(x.y() / kGrid) * kGrid}; }

// Returns whether b is certainly to the left of a. All places are exact, so only the products round.
bool certainly_left(const Vec2& a, const Vec2& b) {
    const double p = a.x() * b.y(), q = a.y() * b.x();
    return p - q > 1e-15 * (std::abs(p) + std::abs(q));
}

Vec2 centroid(const FlatFace& face) { return (face.place[0] + face.place[1] + face.place[2]) / 3; }

}  // namespace

FlatMesh::FlatMesh(const std::vector<Triangle>& triangles, std::vector<FlatFace> faces, uint32_t vertex_count,
                   const TileWalker& walker)
    : walker_(walker), side_(3 * triangles.size(), 0), faces_(std::move(faces)) {
    Topology topology = build_topology({std::vector<Vec3>(vertex_count), triangles});
    for (const Triangle& t : triangles) origin_.insert(origin_.end(), t.begin(), t.end());
    twin_ = std::move(topology.twin);
    outgoing_ = std::move(topology.outgoing);
}

void FlatMesh::mark_side(uint32_t h) { mark(h, true); }

void FlatMesh::mark(uint32_t h, bool is_side) {
    side_[h] = is_side;
    if (twin_[h] != kNone) side_[twin_[h]] = is_side;
}

void FlatMesh::pair(uint32_t a, uint32_t b) {
    if (a != kNone) twin_[a] = b;
    if (b != kNone) twin_[b] = a;
}

// ---- refinement -----------------------------------------------------------------------------------------------------

uint32_t FlatMesh::half_edge_between(uint32_t v, uint32_t w) const {
    uint32_t found = kNone;
    for_each_outgoing(v, [&](uint32_t h) {
        if (target(h) == w) found = h;
    });
    return found;
}

// Finds the fan of a collapse and the edges beside it: into -> left and its twin, right -> into and its twin.
bool FlatMesh::find_fan(const HalfEdgeCollapse& c) {
    undo_.collapse = c;
    undo_.fan.clear();
    undo_.edges = {kNone, kNone, kNone, kNone};
    if (!present(c.into)) return false;
    const bool at_boundary = on_boundary(c.into);
    if ((c.left == kNone || c.right == kNone) && (!at_boundary || c.left == c.right)) return false;
    const uint32_t first = c.left == kNone ? outgoing_[c.into] : half_edge_between(c.into, c.left);
    uint32_t h = first;
    while (h != kNone && target(h) != c.right) {
        undo_.fan.push_back(h);
        h = twin_[prev(h)];
        if (h == first) return false;
    }
    if (!undo_.fan.empty()) {
        if (h == kNone && c.right != kNone && origin_[prev(undo_.fan.back())] != c.right) return false;
        undo_.edges[0] = undo_.fan.front();
        undo_.edges[1] = twin_[undo_.edges[0]];
        undo_.edges[2] = prev(undo_.fan.back());
        undo_.edges[3] = twin_[undo_.edges[2]];
    } else if (c.left == kNone) {
        undo_.edges[3] = h;
    } else {  // the last edge of a boundary vertex
        if (first != kNone || c.right != kNone) return false;
        for_each_outgoing(c.into, [&](uint32_t spoke) { undo_.edges[1] = prev(spoke); });
        if (origin_[undo_.edges[1]] != c.left) return false;
    }
    undo_.ring.clear();
    for (const uint32_t spoke : undo_.fan) undo_.ring.push_back(target(spoke));
    return true;
}

// Adds a face in which `vertex` lies at the place of `into`. shared: its edge from `into` to the third corner, as a
// neighbour has it, in any direction. Returns kNone, and adds nothing, if the tile of the face is uncertain.
uint32_t FlatMesh::add_face(const Triangle& corners, uint32_t third, uint32_t shared) {
    const FlatFace& beside = faces_[face_of(shared)];
    const bool forward = origin_[shared] == undo_.collapse.into;
    const Vec2 start = place(forward ? shared : next(shared)), end = place(forward ? next(shared) : shared);
    FlatFace face;
    for (size_t i = 0; i < 3; ++i) face.place[i] = corners[i] == third ? end : start;
    const auto frame = walker_.walk(beside.tile, centroid(beside), centroid(face));
    if (!frame) return kNone;
    face.tile = frame->tile;
    for (Vec2& p : face.place) p = (*frame)(p);
    faces_.push_back(face);
    origin_.insert(origin_.end(), corners.begin(), corners.end());
    twin_.insert(twin_.end(), 3, kNone);
    side_.insert(side_.end(), 3, 0);
    return face_count() - 1;
}

void FlatMesh::remove_faces(size_t count) {
    const size_t faces = faces_.size() - count;
    faces_.resize(faces);
    origin_.resize(3 * faces);
    twin_.resize(3 * faces);
    side_.resize(3 * faces);
}

bool FlatMesh::split(const HalfEdgeCollapse& c, bool on_side, const std::vector<uint32_t>& ring) {
    if (present(c.vertex) || !find_fan(c) || (!ring.empty() && ring != undo_.ring)) return false;
    const auto [a, a_twin, b, b_twin] = undo_.edges;
    undo_.outgoing = {outgoing_[c.into], c.left == kNone ? kNone : outgoing_[c.left],
                      c.right == kNone ? kNone : outgoing_[c.right], 0};
    const bool at_boundary = c.left == kNone || c.right == kNone;
    bool passes = false;  // the side leaves v inside the fan
    for (size_t i = 1; i < undo_.fan.size(); ++i) passes |= is_side(undo_.fan[i]);
    // An ear: the side goes on from v to the third corner of a new face. On a boundary nothing lies beyond that edge.
    const auto is_ear = [&](uint32_t spoke, uint32_t twin) {
        return at_boundary ? spoke == kNone : on_side && !passes && is_side(spoke != kNone ? spoke : twin);
    };
    const bool left_ear = c.left != kNone && is_ear(a, a_twin);
    const bool right_ear = c.right != kNone && !left_ear && is_ear(b, b_twin);
    undo_.slides = at_boundary || passes || left_ear || right_ear;

    uint32_t left_face = kNone, right_face = kNone;
    if (c.left != kNone) {
        left_face = add_face({c.vertex, c.into, c.left}, c.left, a_twin != kNone ? a_twin : a);
        if (left_face == kNone) return false;
    }
    if (c.right != kNone) {
        right_face = add_face({c.into, c.vertex, c.right}, c.right, b_twin != kNone ? b_twin : b);
        if (right_face == kNone) {
            remove_faces(c.left != kNone);
            return false;
        }
    }
    for (const uint32_t h : undo_.fan) origin_[h] = c.vertex;
    if (left_face != kNone) undo_.sides[0] = insert_face(3 * left_face, a_twin, a, left_ear);
    if (right_face != kNone) undo_.sides[1] = insert_face(3 * right_face, b_twin, b, right_ear);
    if (left_face != kNone && right_face != kNone) pair(3 * left_face, 3 * right_face);
    if (undo_.slides) {
        if (left_face != kNone) side_[3 * left_face] = 1;
        if (right_face != kNone) side_[3 * right_face] = 1;
    }
    restore_outgoing(left_face, right_face);
    return true;
}

// Joins face 3f to what is beside it: `at_into` beyond its edge between `into` and the third corner, `at_vertex` beyond
// the one between `vertex` and the third corner. Returns whether these two were one edge on a side.
uint8_t FlatMesh::insert_face(uint32_t h, uint32_t at_into, uint32_t at_vertex, bool is_ear) {
    const bool left = origin_[h] == undo_.collapse.vertex;
    const uint32_t outer = left ? h + 1 : h + 2, inner = left ? h + 2 : h + 1;
    const uint8_t was_side = side_[at_into != kNone ? at_into : at_vertex];
    pair(outer, at_into);
    pair(inner, at_vertex);
    mark(outer, was_side != 0 && !is_ear);
    mark(inner, is_ear);
    return was_side;
}

// Chooses the half-edges at which the stars begin. On a boundary it is the first one.
void FlatMesh::restore_outgoing(uint32_t left_face, uint32_t right_face) {
    const HalfEdgeCollapse& c = undo_.collapse;
    const auto [a, a_twin, b, b_twin] = undo_.edges;
    if (c.left == kNone) {
        outgoing_[c.vertex] = undo_.fan.empty() ? 3 * right_face + 1 : undo_.fan.front();
        outgoing_[c.into] = 3 * right_face;
    } else {
        outgoing_[c.vertex] = 3 * left_face;
        if (origin_[outgoing_[c.into]] != c.into) outgoing_[c.into] = 3 * left_face + 1;
        if (a == kNone && outgoing_[c.left] == a_twin) outgoing_[c.left] = 3 * left_face + 2;
    }
    if (c.right != kNone && b_twin == kNone && outgoing_[c.right] == b) outgoing_[c.right] = 3 * right_face + 2;
}

void FlatMesh::unsplit() {
    const HalfEdgeCollapse& c = undo_.collapse;
    const auto [a, a_twin, b, b_twin] = undo_.edges;
    for (const uint32_t h : undo_.fan) origin_[h] = c.into;
    if (c.left != kNone) {
        pair(a, a_twin);
        mark(a != kNone ? a : a_twin, undo_.sides[0] != 0);
        outgoing_[c.left] = undo_.outgoing[1];
    }
    if (c.right != kNone) {
        pair(b, b_twin);
        mark(b != kNone ? b : b_twin, undo_.sides[1] != 0);
        outgoing_[c.right] = undo_.outgoing[2];
    }
    outgoing_[c.into] = undo_.outgoing[0];
    outgoing_[c.vertex] = kNone;
    remove_faces(size_t{c.left != kNone} + size_t{c.right != kNone});
}

void FlatMesh::begin_star_at(uint32_t v, uint32_t w) { outgoing_[v] = half_edge_between(v, w); }

// ---- places ---------------------------------------------------------------------------------------------------------

void FlatMesh::unfold(uint32_t v, std::vector<Spoke>& star) const {
    star.clear();
    for_each_outgoing(v, [&](uint32_t h) {
        const FlatFace& face = faces_[face_of(h)];
        const Vec2 at = face.place[h % 3];
        Spoke spoke{h, 0, face.place[next(h) % 3] - at, face.place[prev(h) % 3] - at};
        if (!star.empty()) {
            spoke.quarters = quarters_between(spoke.p1, star.back().p2);
            spoke.p1 = turned(spoke.p1, spoke.quarters);
            spoke.p2 = turned(spoke.p2, spoke.quarters);
        }
        star.push_back(spoke);
    });
}

bool FlatMesh::move(const std::vector<Spoke>& star, const Vec2& x) {
    const Vec2 step = to_grid(x);
    for (const Spoke& spoke : star) {
        if (!certainly_left(spoke.p1 - step, spoke.p2 - step)) return false;
    }
    return move_exactly(star, step);
}

bool FlatMesh::move_onto(const std::vector<Spoke>& star, uint32_t w) {
    Vec2 step = Vec2::Zero();
    for (const Spoke& spoke : star) {
        if (target(spoke.half_edge) == w) step = spoke.p1;
        if (origin_[prev(spoke.half_edge)] == w) step = spoke.p2;
    }
    for (const Spoke& spoke : star) {
        const bool between = target(spoke.half_edge) == w || origin_[prev(spoke.half_edge)] == w;
        if (!between && !certainly_left(spoke.p1 - step, spoke.p2 - step)) return false;
    }
    return move_exactly(star, step);
}

bool FlatMesh::move_exactly(const std::vector<Spoke>& star, const Vec2& step) {
    moved_.clear();
    for (const Spoke& spoke : star) {
        FlatFace face = faces_[face_of(spoke.half_edge)];
        const Vec2 from = centroid(face);
        face.place[spoke.half_edge % 3] += turned(step, 4 - spoke.quarters);
        const Vec2 to = centroid(face);
        if (!in_unit_square(to)) {
            const auto frame = walker_.walk(face.tile, from, to);
            if (!frame) return false;
            face.tile = frame->tile;
            for (Vec2& p : face.place) p = (*frame)(p);
        }
        moved_.push_back(face);
    }
    for (size_t i = 0; i < star.size(); ++i) faces_[face_of(star[i].half_edge)] = moved_[i];
    return true;
}

int FlatMesh::side_axis(uint32_t v) const {
    const Vec2& at = place(outgoing_[v]);
    return at.x() == std::floor(at.x()) ? 1 : 0;
}

}  // namespace gim

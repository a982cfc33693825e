#include "encoder/tiles/tile_mapper.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gim {

namespace {

// A hub of more faces stays. To try all its neighbours takes time that grows with the square of their number.
constexpr size_t kMostSuccessors = 16;
constexpr int kSettlePasses = 2;  // around a corner that moves, before its energy is compared
// Part of the room that a stray vertex takes in a step. A step of descent gives a third more room, so it must be less.
constexpr double kApproach = 0.2;
// A stray vertex that lies behind its neighbour's corner heads for a place this part of its distance before the corner.
constexpr double kLeastAlong = 0.25;

void unify(std::vector<uint32_t>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

TileMapper::TileMapper(FlatMesh& mesh, const std::vector<VertexKind>& kinds, FaceMetrics metrics,
                       std::vector<Freedom> freedom, std::vector<Quad>& quads)
    : mesh_(mesh),
      kinds_(kinds),
      metrics_(metrics),
      freedom_(std::move(freedom)),
      side_(freedom_.size(), kNone),
      quads_(quads) {
    for (uint32_t f = 0; f < mesh_.face_count(); ++f) metric_.push_back(metrics_.of(mesh_.triangle(f)));
}

// ---- descent --------------------------------------------------------------------------------------------------------

double TileMapper::sweep() {
    double gain = 0, total = 0;
    for (uint32_t v = 0; v < freedom_.size(); ++v) {
        if (!mesh_.present(v) || freedom_[v] == Freedom::kPinned) continue;
        const StarDescent descent = relax(v, 1);
        if (freedom_[v] == Freedom::kStray) return_to_side(v);
        if (std::isfinite(descent.before)) gain += descent.before - descent.after, total += descent.after;
    }
    return total > 0 ? 3 * gain / total : 0;  // every triangle is in up to three stars
}

// To try the corners takes longer than a sweep of some thousand vertices. Those that stay rest until the sweeps have come
// to their end.
void TileMapper::sweep_until(int most, double tolerance) {
    bool do_corners_rest = false;
    for (int i = 0; i < most; ++i) {
        const size_t moved = do_corners_rest ? 0 : move_corners();
        const bool is_at_end = sweep() < tolerance;
        if (is_at_end && moved == 0 && !do_corners_rest) break;
        do_corners_rest = moved == 0 && !is_at_end;
    }
}

size_t TileMapper::stray() const {
    size_t count = 0;
    for (uint32_t v = 0; v < freedom_.size(); ++v) count += mesh_.present(v) && freedom_[v] == Freedom::kStray;
    return count;
}

void TileMapper::refresh_metrics(uint32_t v) {
    metric_.resize(mesh_.face_count());
    mesh_.for_each_outgoing(v, [&](uint32_t h) { metric_[face_of(h)] = metrics_.of(mesh_.triangle(face_of(h))); });
}

void TileMapper::load_star(uint32_t v) {
    mesh_.unfold(v, spokes_);
    star_.clear();
    for (const Spoke& spoke : spokes_) {
        const FaceMetric& m = metric_[face_of(spoke.half_edge)];
        const uint32_t i = spoke.half_edge % 3;
        star_.push_back({spoke.p1,
                         spoke.p2,
                         {m.squared_length[i], m.squared_length[(i + 1) % 3], m.squared_length[(i + 2) % 3]},
                         m.weight,
                         m.squeeze});
    }
}

StarDescent TileMapper::relax(uint32_t v, int steps) {
    load_star(v);
    Vec2 x = Vec2::Zero();
    StarDescent descent = descend_star(star_, x, steps, axis_of(v));
    if (x == Vec2::Zero() || !mesh_.move(spokes_, x)) descent.after = descent.before;
    return descent;
}

// ---- vertices that come back ----------------------------------------------------------------------------------------

bool TileMapper::insert_with_help(const HalfEdgeCollapse& collapse, const std::vector<uint32_t>& ring) {
    if (insert(collapse, ring)) return true;
    const uint32_t w = collapse.into;
    if (!mesh_.split(collapse, kinds_[collapse.vertex] != VertexKind::kSmooth, ring)) return false;
    mesh_.unsplit();  // only a place is missing
    return insert_after_bend(collapse, ring) || (freedom_[w] == Freedom::kPinned && insert_after_move(collapse, ring));
}

// Two faces at a vertex of a boundary cannot fill its tiles if these make a full turn. So a neighbour on the boundary
// moves inside for a while.
bool TileMapper::insert_after_bend(const HalfEdgeCollapse& collapse, const std::vector<uint32_t>& ring) {
    for (const uint32_t v : {collapse.left, collapse.right}) {
        if (v == kNone || freedom_[v] != Freedom::kSlides) continue;
        const Patch patch = patch_around(v, collapse.into);
        load_star(v);
        Vec2 mean = Vec2::Zero();
        for (const StarTriangle& t : star_) mean += t.p1 + t.p2;
        approach(mean / static_cast<double>(2 * star_.size()));
        freedom_[v] = Freedom::kStray;
        if (insert(collapse, ring)) return true;
        freedom_[v] = Freedom::kSlides;
        restore(patch);
    }
    return false;
}

bool TileMapper::insert_after_move(const HalfEdgeCollapse& collapse, const std::vector<uint32_t>& ring) {
    const uint32_t w = collapse.into;
    for (const uint32_t v : successors_of(w)) {
        const Patch patch = patch_around(v, w);
        const Freedom freedom = freedom_[v];
        if (exchange(v, w)) {
            rename_corner(w, v);
            if (freedom == Freedom::kSlides) assign_side(w);
            if (insert(collapse, ring)) return true;
            rename_corner(v, w);
        }
        restore(patch);
        freedom_[v] = freedom;
        freedom_[w] = Freedom::kPinned;
    }
    return false;
}

bool TileMapper::insert(const HalfEdgeCollapse& collapse, const std::vector<uint32_t>& ring) {
    if (!mesh_.split(collapse, kinds_[collapse.vertex] != VertexKind::kSmooth, ring)) return false;
    const uint32_t v = collapse.vertex;
    refresh_metrics(v);
    freedom_[v] = mesh_.last_slides() ? Freedom::kSlides : Freedom::kFree;
    if (!find_place(v, collapse.into) && !swap(collapse) && !find_place_beside(collapse)) {
        mesh_.unsplit();
        metric_.resize(mesh_.face_count());
        refresh_metrics(collapse.into);
        return false;
    }
    for (const uint32_t w : {v, collapse.into}) {
        const bool is_new = w == v || side_[w] == kNone;
        if (is_new && (freedom_[w] == Freedom::kSlides || freedom_[w] == Freedom::kStray)) assign_side(w);
    }
    for (const uint32_t w : {collapse.into, collapse.left, collapse.right, v}) {
        if (w != kNone && freedom_[w] != Freedom::kPinned) relax(w, 2);
    }
    return true;
}

// Puts v, which lies at the place of `into`, inside its star.
bool TileMapper::find_place(uint32_t v, uint32_t into) {
    load_star(v);
    if (freedom_[v] == Freedom::kSlides) {
        for (const Neighbour& n : neighbours_on_side(spokes_)) {
            if (n.vertex != into) return place_between(v, Vec2::Zero(), n.place);
        }
        return false;
    }
    const bool open = mesh_.on_boundary(v);
    Vec2 mean = Vec2::Zero(), inside = Vec2::Zero();
    for (const StarTriangle& t : star_) mean += t.p1;
    mean /= static_cast<double>(star_.size());
    if (place_from(mean, open)) return true;
    return find_kernel_point(star_, inside, 1) && place_from(inside, open);
}

bool TileMapper::place_from(const Vec2& start, bool open) {
    if (!(open ? is_upright(start) : winds_once(start, 2 * std::numbers::pi))) return false;
    Vec2 x = start;
    descend_star(star_, x, 4, kAnyDirection);
    return mesh_.move(spokes_, x) || mesh_.move(spokes_, start);
}

// Puts v between two points on the side of a tile.
bool TileMapper::place_between(uint32_t v, const Vec2& first, const Vec2& last) {
    const Vec2 way = last - first;
    if (way.x() != 0 && way.y() != 0) return false;
    double low = 0, high = 1;
    for (const StarTriangle& t : star_) {  // where first + s * way is left of the outer edge
        const double at_first = cross(t.p1 - first, t.p2 - first), at_last = cross(t.p1 - last, t.p2 - last);
        if (at_first <= 0 && at_last <= 0) return false;
        if (at_first < 0) low = std::max(low, at_first / (at_first - at_last));
        if (at_last < 0) high = std::min(high, at_first / (at_first - at_last));
    }
    if (!(low < high)) return false;
    const Vec2 start = first + 0.5 * (low + high) * way;
    const double angle = mesh_.on_boundary(v) ? std::numbers::pi : 2 * std::numbers::pi;
    if (!winds_once(start, angle)) return false;
    Vec2 x = start;
    descend_star(star_, x, 4, way.x() == 0 ? 1 : 0);
    return mesh_.move(spokes_, x) || mesh_.move(spokes_, start);
}

// Puts a vertex of a crease or boundary, for which there is no room on it, anywhere in its star; of a boundary, that may
// be beyond it. Finer faces will give it room. If there is no place at all, a corner of tiles leaves its crease.
bool TileMapper::find_place_beside(const HalfEdgeCollapse& collapse) {
    if (freedom_[collapse.vertex] == Freedom::kSlides) {
        freedom_[collapse.vertex] = Freedom::kStray;
        if (find_place(collapse.vertex, collapse.into)) return true;
    }
    return freedom_[collapse.into] == Freedom::kPinned && !mesh_.on_boundary(collapse.into) &&
           trade_places(collapse.vertex, collapse.into, Freedom::kStray);
}

// Returns whether the triangles of the star are counter-clockwise around x.
bool TileMapper::is_upright(const Vec2& x) const {
    return std::all_of(star_.begin(), star_.end(),
                       [&](const StarTriangle& t) { return cross(t.p1 - x, t.p2 - x) > 0; });
}

// Returns the same, and whether together they have the angle at x: a full turn, or half a one on a boundary.
bool TileMapper::winds_once(const Vec2& x, double angle) const {
    double sum = 0;
    for (const StarTriangle& t : star_) {
        const Vec2 a = t.p1 - x, b = t.p2 - x;
        if (!(cross(a, b) > 0)) return false;
        sum += std::atan2(cross(a, b), a.dot(b));
    }
    return std::abs(sum - angle) < 1;
}

// ---- creases and boundaries -----------------------------------------------------------------------------------------

// The neighbours of a star's vertex along creases and boundaries.
std::vector<TileMapper::Neighbour> TileMapper::neighbours_on_side(const std::vector<Spoke>& star) const {
    std::vector<Neighbour> neighbours;
    for (const Spoke& spoke : star) {
        const uint32_t h = spoke.half_edge, first = next(h), last = prev(h);
        if (mesh_.is_side(h)) neighbours.push_back({mesh_.origin(first), spoke.p1, first, spoke.quarters});
        if (mesh_.twin(last) == kNone) neighbours.push_back({mesh_.origin(last), spoke.p2, last, spoke.quarters});
    }
    return neighbours;
}

// Notes to which side of a tile v belongs: that of its neighbours there, or the one between two corners.
void TileMapper::assign_side(uint32_t v) {
    mesh_.unfold(v, spokes_);
    const std::vector<Neighbour> neighbours = neighbours_on_side(spokes_);
    side_[v] = kNone;
    if (neighbours.size() != 2) return;
    for (const Neighbour& n : neighbours) {
        if (freedom_[n.vertex] != Freedom::kPinned && side_[n.vertex] != kNone) side_[v] = side_[n.vertex];
    }
    if (side_[v] == kNone) side_[v] = side_between(neighbours[0].vertex, neighbours[1].vertex);
}

// The half-edge of the tiles between two corners, in any direction.
uint32_t TileMapper::side_between(uint32_t a, uint32_t b) const {
    for (uint32_t h = 0; h < 4 * quads_.size(); ++h) {
        const uint32_t from = quads_[tile_of(h)][side_of(h)], to = quads_[tile_of(h)][side_of(next_side(h))];
        if ((from == a && to == b) || (from == b && to == a)) return h;
    }
    return kNone;
}

// The direction in which a side leads on from a neighbour that lies on it, towards the vertex v whose star is loaded.
std::optional<Vec2> TileMapper::way_along_side(uint32_t v, const Neighbour& neighbour) const {
    return freedom_[neighbour.vertex] == Freedom::kPinned ? way_from_corner(neighbour, side_[v])
                                                          : way_past(neighbour, v);
}

// From a neighbour that slides: away from its other neighbour.
std::optional<Vec2> TileMapper::way_past(const Neighbour& neighbour, uint32_t v) const {
    std::vector<Spoke> star;
    mesh_.unfold(neighbour.vertex, star);
    for (const Neighbour& other : neighbours_on_side(star)) {
        if (other.vertex == v || freedom_[other.vertex] == Freedom::kStray) continue;
        for (const Spoke& spoke : star) {
            if (spoke.half_edge != neighbour.half_edge) continue;
            const Vec2 way = turned(-other.place, neighbour.quarters + 4 - spoke.quarters);
            return Vec2(way / way.norm());
        }
    }
    return std::nullopt;
}

std::optional<Vec2> TileMapper::way_from_corner(const Neighbour& neighbour, uint32_t side) const {
    const Vec2& at = mesh_.place(neighbour.half_edge);
    if (side == kNone) return std::nullopt;
    const TileWalker& walker = mesh_.walker();
    for (uint32_t i = 0; i < 4; ++i) {
        if (at != TileWalker::corner(i)) continue;
        const Vec2 way = turned(TileWalker::corner((i + 1) % 4) - at, neighbour.quarters);
        const uint32_t first = 4 * mesh_.face(face_of(neighbour.half_edge)).tile + i;
        const auto is_wanted = [&](uint32_t h) { return h == side || walker.mate(h) == side; };
        uint32_t left = first, right = first;  // half-edges that leave the corner, counter-clockwise and clockwise
        for (uint32_t turns = 0; turns < 3; ++turns) {
            if (left != kNoMate && is_wanted(left)) return turned(way, turns);
            if (right != kNoMate && is_wanted(right)) return turned(way, 4 - turns);
            if (left != kNoMate) left = walker.mate(previous_side(left));
            if (right != kNoMate) right = walker.mate(right);
            if (right != kNoMate) right = next_side(right);
        }
    }
    return std::nullopt;
}

// Moves a stray vertex back to the side of its tile if a neighbour is there and its star has room; else nearer to it.
void TileMapper::return_to_side(uint32_t v) {
    load_star(v);
    const std::vector<Neighbour> neighbours = neighbours_on_side(spokes_);
    if (neighbours.size() != 2) return;
    for (size_t i = 0; i < 2; ++i) {
        const Neighbour &near = neighbours[i], &other = neighbours[1 - i];
        if (freedom_[near.vertex] == Freedom::kStray) continue;
        const std::optional<Vec2> way = way_along_side(v, near);
        if (!way) continue;
        const double length = near.place.norm(), along = -near.place.dot(*way);
        const bool both = freedom_[other.vertex] != Freedom::kStray;
        const Vec2 beyond = both ? other.place : Vec2(near.place + 2 * length * *way);
        if (place_between(v, near.place, beyond)) {
            freedom_[v] = Freedom::kSlides;
        } else {
            approach(near.place + std::max(along, kLeastAlong * length) * *way);
        }
        return;
    }
}

// Moves the vertex of the star along a way, by a part of the room that it has.
void TileMapper::approach(const Vec2& way) {
    double room = 1;
    for (const StarTriangle& t : star_) {
        const double here = cross(t.p1, t.p2), there = cross(t.p1 - way, t.p2 - way);
        if (there < here) room = std::min(room, here / (here - there));
    }
    mesh_.move(spokes_, kApproach * room * way);
}

// ---- corners of tiles -----------------------------------------------------------------------------------------------

// Lets the vertex that came back take the place of the base vertex that it was split from, and finds a place for that
// one. So a fan of more than a full turn around a cone does no harm: the other side is less than a turn. On a side the
// same holds for half a turn.
bool TileMapper::swap(const HalfEdgeCollapse& collapse) {
    const uint32_t v = collapse.vertex, w = collapse.into;
    if (freedom_[w] != Freedom::kPinned) return false;
    if (sides_at(w) != (freedom_[v] == Freedom::kSlides ? 2u : 0u)) return false;
    return trade_places(v, w, freedom_[v]);
}

// Pins v, which lies at the place of w, there, and finds another place for w, which may then do as `freedom` says.
bool TileMapper::trade_places(uint32_t v, uint32_t w, Freedom freedom) {
    const Freedom before = freedom_[v];
    if (!mesh_.on_boundary(w)) mesh_.begin_star_at(w, v);
    freedom_[w] = freedom;
    freedom_[v] = Freedom::kPinned;
    if (!find_place(w, v)) {
        freedom_[w] = Freedom::kPinned;
        freedom_[v] = before;
        return false;
    }
    rename_corner(w, v);
    return true;
}

void TileMapper::rename_corner(uint32_t from, uint32_t to) {
    for (Quad& quad : quads_) std::replace(quad.begin(), quad.end(), from, to);
    ++swapped_;
}

std::vector<uint32_t> TileMapper::corners_of_tiles() const {
    std::vector<uint32_t> corners;
    for (const Quad& quad : quads_) corners.insert(corners.end(), quad.begin(), quad.end());
    unify(corners);
    return corners;
}

size_t TileMapper::move_corners() {
    size_t moved = 0;
    for (const uint32_t w : corners_of_tiles()) moved += move_corner(w);
    return moved;
}

size_t TileMapper::sides_at(uint32_t v) const {
    size_t sides = mesh_.on_boundary(v) ? 1 : 0;  // the last edge leaves nothing from v
    mesh_.for_each_outgoing(v, [&](uint32_t h) { sides += mesh_.is_side(h); });
    return sides;
}

// The neighbours that may take the place of a corner. On creases and boundaries, those before and after it.
std::vector<uint32_t> TileMapper::successors_of(uint32_t w) {
    std::vector<uint32_t> successors;
    const size_t sides = sides_at(w);
    mesh_.unfold(w, spokes_);
    if (sides == 2) {
        for (const Neighbour& n : neighbours_on_side(spokes_)) {
            if (freedom_[n.vertex] == Freedom::kSlides) successors.push_back(n.vertex);
        }
    } else if (sides == 0) {
        for (const Spoke& spoke : spokes_) {
            const uint32_t v = mesh_.target(spoke.half_edge);
            if (freedom_[v] == Freedom::kFree) successors.push_back(v);
        }
    }
    return successors;
}

// Lets the neighbour of a corner that lowers the energy most take its place.
bool TileMapper::move_corner(uint32_t w) {
    if (sides_at(w) != 0) return false;
    const std::vector<uint32_t> successors = successors_of(w);
    if (successors.size() > kMostSuccessors) return false;
    double most = 0;
    uint32_t best = kNone;
    for (const uint32_t v : successors) {
        const Patch patch = patch_around(v, w);
        const double before = energy_of(patch);
        if (exchange(v, w)) {
            settle(patch);
            const double gain = before - energy_of(patch);
            if (gain > most) most = gain, best = v;
        }
        restore(patch);
        freedom_[v] = Freedom::kFree;
        freedom_[w] = Freedom::kPinned;
    }
    if (best == kNone) return false;
    const Patch patch = patch_around(best, w);
    exchange(best, w);
    settle(patch);
    rename_corner(w, best);
    return true;
}

// Moves v to the place of w, a corner of tiles, and pins it there; then w finds another place.
bool TileMapper::exchange(uint32_t v, uint32_t w) {
    mesh_.unfold(v, spokes_);
    if (!mesh_.move_onto(spokes_, w)) return false;
    if (!mesh_.on_boundary(w)) mesh_.begin_star_at(w, v);
    freedom_[w] = freedom_[v];
    freedom_[v] = Freedom::kPinned;
    return find_place(w, v);
}

TileMapper::Patch TileMapper::patch_around(uint32_t v, uint32_t w) const {
    Patch patch;
    for (const uint32_t centre : {v, w})
        mesh_.for_each_outgoing(centre, [&](uint32_t h) { patch.vertices.push_back(mesh_.target(h)); });
    unify(patch.vertices);
    for (const uint32_t u : patch.vertices)
        mesh_.for_each_outgoing(u, [&](uint32_t h) { patch.faces.push_back(face_of(h)); });
    unify(patch.faces);
    for (const uint32_t f : patch.faces) patch.before.push_back(mesh_.face(f));
    return patch;
}

double TileMapper::energy_of(const Patch& patch) const {
    double energy = 0;
    for (const uint32_t f : patch.faces) {
        const auto& at = mesh_.face(f).place;
        energy += stretch_energy(metric_[f], at[0], at[1], at[2]);
    }
    return energy;
}

void TileMapper::settle(const Patch& patch) {
    for (int pass = 0; pass < kSettlePasses; ++pass) {
        for (const uint32_t u : patch.vertices) {
            if (freedom_[u] != Freedom::kPinned) relax(u, 1);
        }
    }
}

void TileMapper::restore(const Patch& patch) {
    for (size_t i = 0; i < patch.faces.size(); ++i) mesh_.set_face(patch.faces[i], patch.before[i]);
}

}  // namespace gim

#include "encoder/tiles/collapse_cost.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "encoder/surface/closest_point.h"

namespace gim {

using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

namespace {

// Weight of the moved area times the squared distance, against the quadric error. Larger values lose the tips of limbs.
constexpr double kLengthWeight = 1e-3;
// Weight of the moved area times the squared distance from the vertex to what is left. The planes of a thin limb all pass
// near its root, so the quadric does not notice that its tip vanishes.
constexpr double kTipWeight = 3;
// Weight of a plane across a feature, in squared lengths, against the areas of the faces.
constexpr double kFeatureWeight = 1;
// Cosine of the largest angle by which a collapse may turn a face.
constexpr double kLeastCosine = 0.2, kLeastLooseCosine = -0.3;
// Longest edge over height, times sqrt(3)/2: 1 for the equilateral triangle. Above kNeedle only what is no worse than before.
constexpr double kNeedle = 12, kLooseNeedle = 60;
constexpr double kWidestFan = 1.5 * std::numbers::pi, kWidestLooseFan = 1.9 * std::numbers::pi;
// In the tiles a corner of a face is about 60 degrees wide, whatever it is on the surface. A vertex comes back into the
// fan of faces that it left behind, and that must be narrower than a full turn.
constexpr size_t kMostEdges = 12, kMostLooseFanFaces = 4;
// What the angle of one side of a line counts as. With 2, boundaries of many corners stop the collapses too early.
constexpr double kLineFan = 4.0 / 3;
constexpr double kNeedleWeight = 0.15;
constexpr double kFanWeight = 0.5;
constexpr double kValenceWeight = 0.1;
// No quad may cut a vertex of three edges, so it often leaves a neighbour with two quads.
constexpr double kThreeEdgesPenalty = 20;

// Natural logarithm of the largest ratio between two varied costs.
constexpr double kVariation = 3;
constexpr double kDoubletFactor = 100;

double squared(double x) { return x * x; }

// The longest squared edge over twice the area, 1 for an equilateral triangle.
double slimness(const Vec3& a, const Vec3& b, const Vec3& c, double twice_area) {
    const double longest = std::max({(a - b).squaredNorm(), (b - c).squaredNorm(), (c - a).squaredNorm()});
    return twice_area > 0 ? 0.5 * std::numbers::sqrt3 * longest / twice_area : HUGE_VAL;
}

double angle_at(const Vec3& apex, const Vec3& a, const Vec3& b) {
    const Vec3 u = a - apex, v = b - apex;
    return std::atan2(u.cross(v).norm(), u.dot(v));
}

}  // namespace

std::vector<VertexShare> vertex_shares(const Mesh& mesh, const std::vector<bool>& sharp) {
    const Topology topology = build_topology(mesh);
    std::vector<VertexShare> shares(mesh.positions.size());
    const auto add_plane = [&](uint32_t v, const Vec3& normal, double weight) {
        shares[v].planes.add_plane(normal, -normal.dot(mesh.positions[v]), weight);
    };
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        const Vec3 cross =
            (mesh.positions[t[1]] - mesh.positions[t[0]]).cross(mesh.positions[t[2]] - mesh.positions[t[0]]);
        const double twice_area = cross.norm();
        if (!(twice_area > 0)) continue;
        for (uint32_t i = 0; i < 3; ++i) {
            shares[t[i]].area += twice_area / 6;
            add_plane(t[i], cross / twice_area, twice_area / 6);
            const uint32_t h = 3 * f + i, twin = topology.twin[h];
            const bool feature = twin == kNone || (!sharp.empty() && (sharp[h] || sharp[twin]));
            const Vec3 along = mesh.positions[to(mesh, h)] - mesh.positions[from(mesh, h)];
            if (!feature || !(along.squaredNorm() > 0)) continue;
            const Vec3 across = along.cross(cross).normalized();
            add_plane(from(mesh, h), across, kFeatureWeight * along.squaredNorm());
            add_plane(to(mesh, h), across, kFeatureWeight * along.squaredNorm());
        }
    }
    return shares;
}

void CollapseCost::gather(VertexHandle v) {
    centre_ = v;
    closed_ = !mesh_.is_boundary(v);
    mesh_.outgoing(v, outgoing_);
    spokes_.resize(outgoing_.size());
    for (size_t i = 0; i < spokes_.size(); ++i) {
        const HalfedgeHandle h = outgoing_[i];
        const VertexHandle end = mesh_.to_vertex_handle(h);
        const bool has_face = !mesh_.is_boundary(h);
        spokes_[i] = {h,
                      end,
                      mesh_.place(end),
                      mesh_.is_feature(mesh_.edge_handle(h)),
                      has_face && mesh_.is_feature(mesh_.edge_handle(mesh_.next_halfedge_handle(h))),
                      Vec3::Zero()};
    }
    for (size_t i = 0; i < face_count(); ++i)
        spokes_[i].normal = (spokes_[i].at - mesh_.place(v)).cross(spokes_[after(i)].at - mesh_.place(v));
}

// Whether the rim runs from spoke a to spoke b, in either direction.
bool CollapseCost::joins(size_t a, size_t b) const {
    return (a < face_count() && after(a) == b) || (b < face_count() && after(b) == a);
}

// Whether the edge from the kept vertex to that spoke's end is a feature after the collapse.
bool CollapseCost::feature_after(size_t spoke, size_t onto) const {
    bool feature = spokes_[spoke].feature;
    if (spoke < face_count() && after(spoke) == onto) feature |= spokes_[spoke].rim_feature;
    if (onto < face_count() && after(onto) == spoke) feature |= spokes_[onto].rim_feature;
    return feature;
}

// A boundary of three edges has no legal collapse, so a component with such boundaries might keep an odd number of faces.
bool CollapseCost::boundary_stays_long(size_t onto) const {
    HalfedgeHandle h = spokes_[onto].edge;
    if (!mesh_.is_boundary(mesh_.edge_handle(h))) return true;
    if (!mesh_.is_boundary(h)) h = mesh_.opposite_halfedge_handle(h);
    HalfedgeHandle walk = h;
    for (int i = 0; i < 4; ++i) {
        walk = mesh_.next_halfedge_handle(walk);
        if (walk == h) return false;
    }
    return true;
}

bool CollapseCost::features_allow(size_t onto, Rules rules) const {
    const uint32_t features = mesh_.feature_count(centre_);
    if (!closed_) {
        if (!mesh_.is_boundary(mesh_.edge_handle(spokes_[onto].edge)) || !boundary_stays_long(onto)) return false;
    } else if (features != 0 && rules < Rules::kTopology && !spokes_[onto].feature) {
        return false;
    }
    if (features != 0 && features != 2 && !(features == 1 && rules >= Rules::kLooseShape) && rules < Rules::kTopology)
        return false;
    for (size_t i = 0; i < spokes_.size() && rules < Rules::kTopology; ++i) {
        if (i == onto || !joins(i, onto) || !spokes_[i].feature) continue;
        // A face between two features of the vertex would lie on the straight line that they become.
        if (rules == Rules::kAll) return false;
        const bool rim = (i < face_count() && after(i) == onto) ? spokes_[i].rim_feature : spokes_[onto].rim_feature;
        if (rim) return false;  // two features would become one
    }
    if (rules >= Rules::kTopology) return true;
    for (size_t i = 0; i < face_count(); ++i) {
        if (vanishes(i, onto) || !spokes_[i].rim_feature) continue;
        const bool before = spokes_[i].feature && spokes_[after(i)].feature;
        if (!before && feature_after(i, onto) && feature_after(after(i), onto)) return false;
    }
    return true;
}

// Whether the kept vertex gets more edges than the map can undo.
bool CollapseCost::crowds(size_t onto) const {
    size_t sides = 0;
    for (size_t i = 0; i < spokes_.size(); ++i) sides += i != onto && joins(i, onto);
    return mesh_.edge_count(spokes_[onto].end) + spokes_.size() - 2 - sides > kMostEdges;
}

// The faces that the vertex leaves behind. A vertex on a feature comes back on a straight line between two sides. So each
// side counts by itself, and the wider one decides.
CollapseCost::Fan CollapseCost::fan(size_t onto) const {
    const bool on_line = spokes_[onto].feature;
    Fan side{}, widest{};
    const auto close_side = [&] {
        if (side.angle > widest.angle) widest.angle = side.angle;
        if (side.faces > widest.faces) widest.faces = side.faces;
        side = {};
    };
    for (size_t i = after(onto); i != onto; i = after(i)) {
        if (on_line && spokes_[i].feature) close_side();
        if (i >= face_count() || vanishes(i, onto)) continue;
        side.angle += angle_at(spokes_[onto].at, spokes_[i].at, spokes_[after(i)].at);
        ++side.faces;
    }
    close_side();
    if (on_line) widest.angle *= kLineFan;
    if (!closed_) widest.faces *= 2;
    return widest;
}

// The squared distance from the vertex to the faces that take the place of its own.
double CollapseCost::squared_gap(size_t onto) const {
    double least = (mesh_.place(centre_) - spokes_[onto].at).squaredNorm();
    for (size_t i = 0; i < face_count(); ++i) {
        if (vanishes(i, onto)) continue;
        const Vec3 point =
            closest_point_on_triangle(mesh_.place(centre_), spokes_[onto].at, spokes_[i].at, spokes_[after(i)].at)
                .point;
        least = std::min(least, (mesh_.place(centre_) - point).squaredNorm());
    }
    return least;
}

std::optional<double> CollapseCost::shape_factor(size_t onto, Rules rules) const {
    const bool loose = rules >= Rules::kLooseShape;
    const Vec3 old_place = mesh_.place(centre_);
    const Vec3& new_place = spokes_[onto].at;
    double worst = 1;
    for (size_t i = 0; i < face_count(); ++i) {
        if (vanishes(i, onto)) continue;
        const Vec3 &a = spokes_[i].at, &b = spokes_[after(i)].at, &before = spokes_[i].normal;
        const Vec3 now = (a - new_place).cross(b - new_place);
        const double areas = before.norm() * now.norm();
        if (before.squaredNorm() > 0 && !(before.dot(now) > (loose ? kLeastLooseCosine : kLeastCosine) * areas))
            return {};
        const double slim = slimness(a, b, new_place, now.norm());
        if (slim > (loose ? kLooseNeedle : kNeedle) && slim > slimness(a, b, old_place, before.norm())) return {};
        worst = std::max(worst, slim);
    }
    const Fan left_behind = fan(onto);
    if (left_behind.angle > (loose ? kWidestLooseFan : kWidestFan)) return {};
    if (loose && left_behind.faces > kMostLooseFanFaces) return {};
    return 1 + kNeedleWeight * squared(std::min(worst, kLooseNeedle) - 1) +
           kFanWeight * squared(squared(left_behind.angle / std::numbers::pi));
}

double CollapseCost::valence_factor(size_t onto) const {
    const auto irregularity = [&](VertexHandle v, double edges) {
        if (mesh_.is_boundary(v)) return squared(edges - 4);
        return squared(edges - 6) + (edges <= 3 ? kThreeEdgesPenalty : 0);
    };
    const auto edges = [&](VertexHandle v) { return static_cast<double>(mesh_.edge_count(v)); };
    const VertexHandle u = spokes_[onto].end;
    double change = -irregularity(centre_, edges(centre_)) - irregularity(u, edges(u));
    double sides = 0;
    for (size_t i = 0; i < spokes_.size(); ++i) {
        if (i == onto || !joins(i, onto)) continue;
        const VertexHandle w = spokes_[i].end;
        change += irregularity(w, edges(w) - 1) - irregularity(w, edges(w));
        ++sides;
    }
    change += irregularity(u, edges(u) + edges(centre_) - 2 - sides);
    return std::exp(kValenceWeight * std::clamp(change, -20.0, 30.0));
}

double CollapseCost::variation(size_t onto) const {
    if (seeds_.empty() || seeds_[index(centre_)] == 0) return 1;
    uint64_t hash =
        (uint64_t{seeds_[index(centre_)]} << 40) ^ (uint64_t{index(centre_)} << 20) ^ index(spokes_[onto].end);
    for (const int shift : {31, 29, 32}) hash = (hash ^ (hash >> shift)) * 0x9E3779B97F4A7C15u;
    return std::exp(kVariation * (static_cast<double>(hash >> 11) * 0x1p-53 - 0.5));
}

// No quad may cut a vertex of three edges, and only one a vertex of four. So a vertex of three needs neighbours of five,
// and a face of three vertices of four edges leaves one of them with two quads.
bool CollapseCost::makes_doublet(size_t onto) {
    const VertexHandle into = spokes_[onto].end;
    VertexHandle sides[2];
    size_t side_count = 0;
    for (size_t i = 0; i < spokes_.size(); ++i) {
        if (i != onto && joins(i, onto)) sides[side_count++] = spokes_[i].end;
    }
    const auto edges = [&](VertexHandle w) -> uint32_t {
        if (mesh_.is_boundary(w)) return 6;
        if (w == into) return mesh_.edge_count(w) + mesh_.edge_count(centre_) - 2 - static_cast<uint32_t>(side_count);
        const bool loses = (side_count > 0 && w == sides[0]) || (side_count > 1 && w == sides[1]);
        return mesh_.edge_count(w) - loses;
    };
    for (size_t s = 0; s < side_count; ++s) {
        const uint32_t mine = edges(sides[s]);
        if (mine > 4) continue;
        mesh_.outgoing(sides[s], ring_);
        uint32_t before = 6;  // edges of the neighbour before
        for (size_t i = 0; i <= ring_.size(); ++i) {
            const VertexHandle w = mesh_.to_vertex_handle(ring_[i == ring_.size() ? 0 : i]);
            if (w == centre_) continue;
            const uint32_t theirs = edges(w);
            if (mine == 3 && theirs <= 4) return true;
            if (mine == 4 && (theirs == 3 || (theirs == 4 && before == 4))) return true;
            before = theirs;
        }
    }
    return false;
}

std::optional<double> CollapseCost::cost(size_t onto, Rules rules, double limit) {
    const Spoke& spoke = spokes_[onto];
    const VertexShare& mine = shares_[index(centre_)];
    const double error = std::max(0.0, mine.planes(spoke.at) + shares_[index(spoke.end)].planes(spoke.at));
    const double length = mine.area * (mesh_.place(centre_) - spoke.at).squaredNorm();
    const double irregular = valence_factor(onto) * variation(onto);
    // Each term makes it dearer, so the dear ones are looked at last.
    double cost = (error + kLengthWeight * length) * irregular;
    if (cost >= limit || crowds(onto) || !features_allow(onto, rules)) return {};
    cost += kTipWeight * mine.area * squared_gap(onto) * irregular;
    if (cost >= limit) return {};
    if (makes_doublet(onto)) cost *= kDoubletFactor;
    if (cost >= limit) return {};
    const auto shape = shape_factor(onto, rules);
    if (!shape || cost * *shape >= limit || !mesh_.is_collapse_ok(spoke.edge)) return {};
    return cost * *shape;
}

CollapseCost::Candidate CollapseCost::best(VertexHandle v, Rules rules) {
    gather(v);
    Candidate result{HUGE_VAL, HalfedgeHandle()};
    for (size_t i = 0; i < spokes_.size(); ++i) {
        if (const auto now = cost(i, rules, result.cost)) result = {*now, spokes_[i].edge};
    }
    return result;
}

std::optional<double> CollapseCost::cost_of(HalfedgeHandle h, Rules rules) {
    gather(mesh_.from_vertex_handle(h));
    const auto onto = std::find(outgoing_.begin(), outgoing_.end(), h);
    return cost(static_cast<size_t>(onto - outgoing_.begin()), rules, HUGE_VAL);
}

double CollapseCost::damage(HalfedgeHandle h) {
    gather(mesh_.from_vertex_handle(h));
    const auto onto = static_cast<size_t>(std::find(outgoing_.begin(), outgoing_.end(), h) - outgoing_.begin());
    const VertexShare& mine = shares_[index(centre_)];
    return std::max(0.0, mine.planes(spokes_[onto].at)) + kTipWeight * mine.area * squared_gap(onto);
}

}  // namespace gim

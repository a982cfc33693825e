#include "encoder/tiles/tile_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "encoder/surface/face_metrics.h"
#include "encoder/surface/refine.h"
#include "encoder/tiles/code_complex.h"
#include "encoder/tiles/flat_mesh.h"
#include "encoder/tiles/locate_samples.h"
#include "encoder/tiles/start_map.h"
#include "encoder/tiles/tile_walk.h"

namespace gim {

namespace {

constexpr int kBaseSweeps = 50;

// What a vertex may do.
enum class Freedom : uint8_t {
    kFree,
    kSlides,  // along the border of a tile
    kStray,   // belongs to such a border, but had no place there yet
    kPinned,  // to a corner of tiles
};

// Optimises the map on a mesh that is refined step by step.
class TileMapper {
  public:
    TileMapper(FlatMesh& mesh, FaceMetrics metrics, std::vector<Freedom> freedom, std::vector<Quad>& quads)
        : mesh_(mesh), metrics_(metrics), freedom_(std::move(freedom)), quads_(quads) {
        for (uint32_t f = 0; f < mesh_.face_count(); ++f) metric_.push_back(metrics_.of(mesh_.triangle(f)));
    }

    // Makes one pass over all vertices. Returns the energy gained, as a part of the energy that is left.
    double sweep() {
        double gain = 0, total = 0;
        for (uint32_t v = 0; v < freedom_.size(); ++v) {
            if (!mesh_.present(v) || freedom_[v] == Freedom::kPinned) continue;
            const StarDescent descent = relax(v, 1);
            if (freedom_[v] == Freedom::kStray) return_to_side(v);
            if (std::isfinite(descent.before)) gain += descent.before - descent.after, total += descent.after;
        }
        return total > 0 ? 3 * gain / total : 0;  // every triangle is in up to three stars
    }

    void sweep_until(int most, double tolerance) {
        for (int i = 0; i < most; ++i) {
            if (sweep() < tolerance) break;
        }
    }

    // Brings a vertex back. ring: of the split (FlatMesh::split). Returns false, and changes nothing, if there is no
    // place for it.
    bool insert(const HalfEdgeCollapse& collapse, const std::vector<uint32_t>& ring) {
        if (!mesh_.split(collapse, ring)) return false;
        const uint32_t v = collapse.vertex;
        refresh_metrics(v);
        freedom_[v] = mesh_.last_slides() ? Freedom::kSlides : Freedom::kFree;
        if (!find_place(v, collapse.into) && !swap(collapse) && !find_place_beside(collapse)) {
            mesh_.unsplit();
            metric_.resize(mesh_.face_count());
            refresh_metrics(collapse.into);
            return false;
        }
        for (const uint32_t w : {collapse.into, collapse.left, collapse.right, v}) {
            if (w != kNone && freedom_[w] != Freedom::kPinned) relax(w, 2);
        }
        return true;
    }
    uint32_t swapped() const { return swapped_; }
    size_t stray() const {
        size_t count = 0;
        for (uint32_t v = 0; v < freedom_.size(); ++v) count += mesh_.present(v) && freedom_[v] == Freedom::kStray;
        return count;
    }

  private:
    void refresh_metrics(uint32_t v) {
        metric_.resize(mesh_.face_count());
        mesh_.for_each_outgoing(v, [&](uint32_t h) { metric_[face_of(h)] = metrics_.of(mesh_.triangle(face_of(h))); });
    }

    void load_star(uint32_t v) {
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

    int axis_of(uint32_t v) const { return freedom_[v] == Freedom::kSlides ? mesh_.side_axis(v) : kAnyDirection; }

    StarDescent relax(uint32_t v, int steps) {
        load_star(v);
        Vec2 x = Vec2::Zero();
        StarDescent descent = descend_star(star_, x, steps, axis_of(v));
        if (x == Vec2::Zero() || !mesh_.move(spokes_, x)) descent.after = descent.before;
        return descent;
    }

    // Puts v, which lies at the place of `into`, inside its star.
    bool find_place(uint32_t v, uint32_t into) {
        load_star(v);
        if (freedom_[v] == Freedom::kSlides) {
            const std::optional<Vec2> beyond = next_on_side(into);
            return beyond && place_between(v, Vec2::Zero(), *beyond);
        }
        Vec2 mean = Vec2::Zero(), inside = Vec2::Zero();
        for (const StarTriangle& t : star_) mean += t.p1;
        mean /= static_cast<double>(star_.size());
        if (place_from(mean)) return true;
        return find_kernel_point(star_, inside) && place_from(inside);
    }

    bool place_from(const Vec2& start) {
        if (!winds_once(start, 2 * std::numbers::pi)) return false;
        Vec2 x = start;
        descend_star(star_, x, 4, kAnyDirection);
        return mesh_.move(spokes_, x) || mesh_.move(spokes_, start);
    }

    // The place of the neighbour on the side of a tile that is not w. Places count from the star's vertex.
    std::optional<Vec2> next_on_side(uint32_t w) const {
        for (const Spoke& spoke : spokes_) {
            const uint32_t h = spoke.half_edge;
            if (mesh_.is_side(h) && mesh_.target(h) != w) return spoke.p1;
            if (mesh_.is_side(prev(h)) && mesh_.origin(prev(h)) != w) return spoke.p2;
        }
        return std::nullopt;
    }

    // Puts v between two points on the side of a tile.
    bool place_between(uint32_t v, const Vec2& first, const Vec2& last) {
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

    // Puts a vertex of a crease, for which there is no room on the crease, anywhere in its star. Finer faces will give it
    // room. If there is no place at all, a corner of tiles leaves its crease.
    bool find_place_beside(const HalfEdgeCollapse& collapse) {
        if (mesh_.on_boundary(collapse.vertex)) return false;
        if (freedom_[collapse.vertex] == Freedom::kSlides) {
            freedom_[collapse.vertex] = Freedom::kStray;
            if (find_place(collapse.vertex, collapse.into)) return true;
        }
        return freedom_[collapse.into] == Freedom::kPinned && !mesh_.on_boundary(collapse.into) &&
               trade_places(collapse.vertex, collapse.into, Freedom::kStray);
    }

    // Moves a stray vertex back to the side of its tile if a neighbour is there and its star has room.
    void return_to_side(uint32_t v) {
        load_star(v);
        std::vector<uint32_t> neighbours;
        std::vector<Vec2> ends;
        for (const Spoke& spoke : spokes_) {
            if (!mesh_.is_side(spoke.half_edge)) continue;
            neighbours.push_back(mesh_.target(spoke.half_edge));
            ends.push_back(spoke.p1);
        }
        if (neighbours.size() != 2) return;
        for (size_t i = 0; i < 2; ++i) {
            if (freedom_[neighbours[i]] == Freedom::kStray) continue;
            const bool both = freedom_[neighbours[1 - i]] != Freedom::kStray;
            const Vec2 beyond = both ? ends[1 - i] : beyond_on_side(neighbours[i], ends[i]);
            const Vec2 at = mesh_.place(spokes_.front().half_edge) + ends[i];
            const bool upright = ends[i].x() == beyond.x() && at.x() == std::floor(at.x());
            const bool level = ends[i].y() == beyond.y() && at.y() == std::floor(at.y());
            if (upright == level || !place_between(v, ends[i], beyond)) continue;
            freedom_[v] = Freedom::kSlides;
            return;
        }
    }

    // Where the side through a neighbour leads past the star's vertex. `end`: the neighbour's place.
    Vec2 beyond_on_side(uint32_t neighbour, const Vec2& end) const {
        bool along_x = std::abs(end.x()) > std::abs(end.y());
        if (freedom_[neighbour] == Freedom::kSlides) {
            const Vec2 at = mesh_.place(spokes_.front().half_edge) + end;
            along_x = at.x() != std::floor(at.x());
        }
        return along_x ? Vec2(-end.x(), end.y()) : Vec2(end.x(), -end.y());
    }

    // Returns whether the triangles of the star are counter-clockwise around x, and go around it once.
    bool winds_once(const Vec2& x, double angle) const {
        double sum = 0;
        for (const StarTriangle& t : star_) {
            const Vec2 a = t.p1 - x, b = t.p2 - x;
            if (!(cross(a, b) > 0)) return false;
            sum += std::atan2(cross(a, b), a.dot(b));
        }
        return std::abs(sum - angle) < 1;
    }

    // Lets the vertex that came back take the place of the base vertex that it was split from, and finds a place for
    // that one. So a fan of more than a full turn around a cone does no harm: the other side is less than a turn. On a
    // side the same holds for half a turn.
    bool swap(const HalfEdgeCollapse& collapse) {
        const uint32_t v = collapse.vertex, w = collapse.into;
        if (freedom_[w] != Freedom::kPinned) return false;
        size_t sides = mesh_.on_boundary(w) ? 1 : 0;  // the last edge leaves nothing from w
        mesh_.for_each_outgoing(w, [&](uint32_t h) { sides += mesh_.is_side(h); });
        if (sides != (freedom_[v] == Freedom::kSlides ? 2u : 0u)) return false;
        return trade_places(v, w, freedom_[v]);
    }

    // Pins v, which lies at the place of w, there, and finds another place for w, which may then do as `freedom` says.
    bool trade_places(uint32_t v, uint32_t w, Freedom freedom) {
        const Freedom before = freedom_[v];
        if (!mesh_.on_boundary(w)) mesh_.begin_star_at(w, v);
        freedom_[w] = freedom;
        freedom_[v] = Freedom::kPinned;
        if (!find_place(w, v)) {
            freedom_[w] = Freedom::kPinned;
            freedom_[v] = before;
            return false;
        }
        for (Quad& quad : quads_) std::replace(quad.begin(), quad.end(), w, v);
        ++swapped_;
        return true;
    }

    FlatMesh& mesh_;
    FaceMetrics metrics_;
    std::vector<FaceMetric> metric_;
    std::vector<Freedom> freedom_;
    std::vector<Quad>& quads_;
    std::vector<Spoke> spokes_;
    std::vector<StarTriangle> star_;
    uint32_t swapped_ = 0;
};

// Undoes all collapses without any geometry. Returns the ring of each, or an Error if one cannot be undone.
Result<std::vector<std::vector<uint32_t>>> rings_of(FlatMesh mesh, const std::vector<HalfEdgeCollapse>& collapses) {
    std::vector<std::vector<uint32_t>> rings(collapses.size());
    for (size_t k = collapses.size(); k-- > 0;) {
        if (!mesh.split(collapses[k], {}))
            return Error{Stage::kParametrize,
                         "collapse " + std::to_string(k) + " cannot be undone; this is an error of the program"};
        rings[k] = mesh.last_ring();
    }
    return rings;
}

Triangle smallest_first(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

// Returns the faces of the flat mesh in the order of the triangles of `dense`; others come after them.
TileMap read_map(const FlatMesh& mesh, const Mesh& dense, const TileWalker& walker) {
    struct Named {
        Triangle corners;
        uint32_t number;
    };
    const auto before = [](const Named& a, const Named& b) { return a.corners < b.corners; };
    std::vector<Named> names;
    for (uint32_t f = 0; f < dense.triangles.size(); ++f) names.push_back({smallest_first(dense.triangles[f]), f});
    std::sort(names.begin(), names.end(), before);
    std::vector<uint32_t> order;
    std::vector<std::array<uint32_t, 2>> ranked;
    for (uint32_t f = 0; f < mesh.face_count(); ++f) {
        const Named name{smallest_first(mesh.triangle(f)), f};
        const auto found = std::lower_bound(names.begin(), names.end(), name, before);
        const bool same = found != names.end() && found->corners == name.corners;
        ranked.push_back({same ? found->number : kNone, f});
    }
    std::sort(ranked.begin(), ranked.end());

    TileMap map;
    map.places.resize(mesh.vertex_count());
    for (const auto& [number, f] : ranked) {
        const FlatFace& face = mesh.face(f);
        Triangle triangle = mesh.triangle(f);
        TileTriangle placed{face.place, face.tile};
        if (number != kNone) {
            while (triangle[0] != dense.triangles[number][0]) {
                std::rotate(triangle.begin(), triangle.begin() + 1, triangle.end());
                std::rotate(placed.corners.begin(), placed.corners.begin() + 1, placed.corners.end());
            }
        }
        const Vec2 centre = (face.place[0] + face.place[1] + face.place[2]) / 3;
        for (size_t i = 0; i < 3; ++i) {
            if (map.places[triangle[i]].tile != kNone) continue;
            const auto frame = walker.walk(placed.tile, centre, placed.corners[i]);
            if (frame) map.places[triangle[i]] = {frame->tile, (*frame)(placed.corners[i])};
        }
        map.triangles.push_back(triangle);
        map.placed.push_back(placed);
    }
    return map;
}

}  // namespace

Result<TileMap> map_tiles(const Mesh& dense, const BaseMesh& base, const std::vector<Quad>& quads,
                          const TileMapOptions& options, const Progress& progress) {
    const auto vertex_count = static_cast<uint32_t>(dense.positions.size());
    const NumberedQuads numbered = number_quads(quads);
    GIM_TRY(complex, complex_of(numbered.quads, static_cast<uint32_t>(numbered.vertices.size())));
    const TileWalker walker({complex.view().mate, complex.view().mate + complex.view().half_edges()});
    GIM_TRY(start, start_map(base.triangles, quads, vertex_count));
    FlatMesh mesh(base.triangles, start, vertex_count, walker);
    std::vector<Freedom> freedom(vertex_count, Freedom::kFree);
    for (const Quad& quad : quads) {
        for (const uint32_t v : quad) freedom[v] = Freedom::kPinned;
    }
    std::vector<std::array<uint32_t, 2>> creases;
    for (const auto& [a, b] : base.creases) creases.push_back({std::min(a, b), std::max(a, b)});
    std::sort(creases.begin(), creases.end());
    for (uint32_t h = 0; h < 3 * mesh.face_count(); ++h) {
        if (mesh.twin(h) == kNone) mesh.mark_side(h);
    }
    for (const Quad& quad : quads) {  // creases that cross a tile bind nothing
        for (size_t i = 0; i < 4; ++i) {
            const std::array<uint32_t, 2> side{std::min(quad[i], quad[(i + 1) % 4]),
                                               std::max(quad[i], quad[(i + 1) % 4])};
            const bool crease = std::binary_search(creases.begin(), creases.end(), side);
            if (crease) mesh.mark_side(mesh.half_edge_between(quad[i], quad[(i + 1) % 4]));
        }
    }
    GIM_TRY(rings, rings_of(mesh, base.collapses));

    std::vector<Quad> corners = quads;
    FaceMetrics metrics(dense.positions, options.importance, surface_area(dense), static_cast<double>(quads.size()),
                        options.squeeze);
    metrics.set_least_area(base.triangles, dense.triangles.size());
    TileMapper mapper(mesh, metrics, std::move(freedom), corners);
    mapper.sweep_until(kBaseSweeps, options.tolerance);

    const size_t total = base.collapses.size();
    size_t present = base.triangles.size() / 2, sweep_at = present;
    std::vector<uint32_t> waiting;
    const auto retry = [&] {
        for (bool found = true; found && !waiting.empty();) {
            std::vector<uint32_t> still;
            for (const uint32_t k : waiting) {
                if (!mapper.insert(base.collapses[k], rings[k])) still.push_back(k);
            }
            found = still.size() < waiting.size();
            waiting = std::move(still);
        }
    };
    for (size_t k = total; k-- > 0;) {
        if (!mapper.insert(base.collapses[k], rings[k])) waiting.push_back(static_cast<uint32_t>(k));
        if (++present < static_cast<size_t>(options.growth * static_cast<double>(sweep_at))) continue;
        sweep_at = present;
        mapper.sweep_until(options.sweeps, options.tolerance);
        retry();
        if (progress) progress(Stage::kParametrize, 1 - static_cast<double>(k) / static_cast<double>(total));
    }
    retry();
    mapper.sweep_until(options.final_sweeps, options.tolerance);
    retry();

    TileMap map = read_map(mesh, dense, walker);
    map.quads = std::move(corners);
    map.swapped = mapper.swapped();
    map.stray = mapper.stray();
    for (const uint32_t k : waiting) map.left_out.push_back(base.collapses[k].vertex);
    return map;
}

double stretch_efficiency(const std::vector<Vec3>& positions, const TileMap& map) {
    double energy = 0, area = 0;
    for (size_t f = 0; f < map.triangles.size(); ++f) {
        const Triangle& t = map.triangles[f];
        const FaceMetric metric = face_metric(positions[t[0]], positions[t[1]], positions[t[2]], 0);
        if (metric.weight == 0) continue;
        const auto& [a, b, c] = map.placed[f].corners;
        energy += stretch_energy(metric, a, b, c);
        area += 2 * metric.weight;
    }
    return area * area / (static_cast<double>(map.quads.size()) * energy);
}

}  // namespace gim

#include "encoder/tiles/tile_map.h"

#include <algorithm>
#include <string>

#include "encoder/surface/face_metrics.h"
#include "encoder/surface/refine.h"
#include "encoder/tiles/code_complex.h"
#include "encoder/tiles/flat_mesh.h"
#include "encoder/tiles/locate_samples.h"
#include "encoder/tiles/start_map.h"
#include "encoder/tiles/tile_mapper.h"
#include "encoder/tiles/tile_walk.h"

namespace gim {

namespace {

constexpr int kBaseSweeps = 50;

// Undoes all collapses without any geometry. Returns the ring of each, or an Error if one cannot be undone.
Result<std::vector<std::vector<uint32_t>>> rings_of(FlatMesh mesh, const BaseMesh& base) {
    const std::vector<HalfEdgeCollapse>& collapses = base.collapses;
    std::vector<std::vector<uint32_t>> rings(collapses.size());
    for (size_t k = collapses.size(); k-- > 0;) {
        if (!mesh.split(collapses[k], base.kinds[collapses[k].vertex] != VertexKind::kSmooth, {}))
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

    const auto tile_count = static_cast<uint32_t>(walker.complex_tiles());
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
            if (map.places[triangle[i]].tile < tile_count) continue;
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
    const TileWalker walker = TileWalker::with_fringe(complex.view());
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
    GIM_TRY(rings, rings_of(mesh, base));

    std::vector<Quad> corners = quads;
    FaceMetrics metrics(dense.positions, options.importance, surface_area(dense), static_cast<double>(quads.size()),
                        options.squeeze);
    metrics.set_least_area(base.triangles, dense.triangles.size());
    TileMapper mapper(mesh, base.kinds, metrics, std::move(freedom), corners);
    mapper.sweep_until(kBaseSweeps, options.tolerance);

    const size_t total = base.collapses.size();
    size_t present = base.triangles.size() / 2, sweep_at = present;
    std::vector<uint32_t> waiting;
    const auto retry = [&] {
        for (bool found = true; found && !waiting.empty();) {
            std::vector<uint32_t> still;
            for (const uint32_t k : waiting) {
                if (!mapper.insert_with_help(base.collapses[k], rings[k])) still.push_back(k);
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

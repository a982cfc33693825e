#include "encoder/augment_cut.h"

#include <algorithm>
#include <limits>

#include "encoder/circle_map.h"
#include "encoder/parametrize.h"
#include "encoder/progressive_mesh.h"
#include "encoder/result.h"
#include "encoder/stretch.h"

namespace gim {

namespace {

// The surface that the search runs on.
struct Surface {
    const Mesh& mesh;
    const Topology& topology;
};

// Stretch efficiency of the best map to the square that this cut allows.
Result<double> judge(const Surface& surface, const CutEdges& cut, const BoundaryMapOptions& options) {
    GIM_TRY(opened, open_mesh(surface.mesh, surface.topology, cut));
    GIM_TRY(boundary, map_boundary(std::move(opened), options));
    GIM_TRY(uv, parametrize(boundary.opened.mesh, boundary.sides, boundary_uv(boundary, options.side), {}));
    return stretch_efficiency(boundary.opened.mesh, uv, 1.0);
}

// The vertex off the cut at the triangle of greatest stretch under the circle map; kNone when every vertex is on the
// cut.
uint32_t find_extremum(const Surface& surface, const CutEdges& cut) {
    auto opened = open_mesh(surface.mesh, surface.topology, cut);
    if (!opened.ok()) return kNone;
    const OpenedMesh& disk = opened.value();
    const std::vector<Vec2> uv = circle_map(disk);
    if (uv.empty()) return kNone;
    const std::vector<uint32_t> valence = cut_valence(surface.mesh, surface.topology, cut);
    uint32_t extremum = kNone;
    double most = -1;
    for (const Triangle& t : disk.mesh.triangles) {
        const FaceMetric metric =
            face_metric(disk.mesh.positions[t[0]], disk.mesh.positions[t[1]], disk.mesh.positions[t[2]], 0);
        if (metric.weight == 0) continue;
        const double stretch = stretch_energy(metric, uv[t[0]], uv[t[1]], uv[t[2]]) / metric.weight;
        if (stretch <= most) continue;
        for (const uint32_t v : t) {
            if (valence[disk.source[v]] != 0) continue;
            extremum = disk.source[v];
            most = stretch;
            break;
        }
    }
    return extremum;
}

// The shortest path from the cut to v, added to the cut.
CutEdges extend_cut(const Surface& surface, const CutEdges& cut, uint32_t v) {
    const std::vector<uint32_t> valence = cut_valence(surface.mesh, surface.topology, cut);
    std::vector<uint8_t> on_cut(valence.size()), off_cut(valence.size());
    for (size_t i = 0; i < valence.size(); ++i) on_cut[i] = valence[i] != 0, off_cut[i] = valence[i] == 0;
    CutEdges extended = cut;
    mark_path(surface.topology, shortest_path(surface.mesh, surface.topology, {v}, on_cut, off_cut), 1, extended);
    return extended;
}

CutEdges edges_at(const Surface& surface, uint32_t v) {
    CutEdges cut(surface.topology.twin.size(), 0);
    const uint32_t h = surface.topology.outgoing[v];
    mark_path(surface.topology, {h, prev(h)}, 1, cut);
    return cut;
}

// Closed surface of genus 0: start over from the first extremum, then cut from there to the second.
CutEdges restart_at_extremum(const Surface& surface, const CutEdges& cut, std::vector<AugmentStep>& steps) {
    const uint32_t first = find_extremum(surface, cut);
    if (first == kNone) return cut;
    const CutEdges bootstrap = edges_at(surface, first);
    const uint32_t second = find_extremum(surface, bootstrap);
    if (second == kNone || second == first) return bootstrap;
    std::vector<uint8_t> goal(surface.mesh.positions.size(), 0);
    goal[first] = 1;
    const std::vector<uint32_t> path =
        shortest_path(surface.mesh, surface.topology, {second}, goal, std::vector<uint8_t>(goal.size(), 1));
    if (path.size() < 2) return bootstrap;
    CutEdges result(cut.size(), 0);
    mark_path(surface.topology, path, 1, result);
    steps.push_back({0, first});
    steps.push_back({0, second});
    return result;
}

bool is_sphere(const Surface& surface) {
    const auto faces = static_cast<int64_t>(surface.mesh.triangles.size());
    const bool closed =
        std::none_of(surface.topology.twin.begin(), surface.topology.twin.end(), [](uint32_t t) { return t == kNone; });
    return closed && static_cast<int64_t>(surface.mesh.positions.size()) - faces / 2 == 2;
}

Result<FoundCut> search(const Surface& surface, const AugmentOptions& options, const Progress& progress) {
    FoundCut best;
    best.cut = straighten_cut(surface.mesh, surface.topology, initial_cut(surface.mesh, surface.topology, 0));
    if (is_sphere(surface)) best.cut = restart_at_extremum(surface, best.cut, best.steps);
    GIM_TRY(first_efficiency, judge(surface, best.cut, options.boundary));
    best.steps.push_back({first_efficiency, kNone});

    FoundCut trial = best;
    double best_efficiency = first_efficiency;
    for (uint32_t i = 0, misses = 0; i < options.most_paths && misses < options.patience; ++i) {
        if (progress) progress(Stage::kCut, double(i) / options.most_paths);
        const uint32_t extremum = find_extremum(surface, trial.cut);
        if (extremum == kNone) break;
        trial.cut = extend_cut(surface, trial.cut, extremum);
        const Result<double> efficiency = judge(surface, trial.cut, options.boundary);
        if (!efficiency.ok()) break;  // more cut-paths than the ring can hold
        trial.steps.push_back({efficiency.value(), extremum});
        if (efficiency.value() <= best_efficiency) {
            ++misses;
            continue;
        }
        misses = 0;
        best = trial;
        best_efficiency = efficiency.value();
    }
    return best;
}

// Carries a cut of the coarse mesh to the full one: at every vertex split the cut stays the same curve up to a slide
// across the faces that come back, so it still opens the surface into a disk.
class CutRefiner {
  public:
    CutRefiner(ProgressiveMesh& mesh, CutEdges cut) : mesh_(mesh), cut_(std::move(cut)) {}

    CutEdges run() {
        while (mesh_.coarsened()) refine();
        return std::move(cut_);
    }

  private:
    void refine() {
        const VertexSplit split = mesh_.split();
        const uint32_t h = split.edge, t = mesh_.twin(h);
        // Edges that the collapse merged: vertex-left with into-left, vertex-right with into-right. Where the outer
        // twin is missing the merged edge was an input boundary, which needs no mark.
        const bool left = take(prev(h)) | take(next(h)), right = take(next(t)) | take(prev(t));
        set(h, 0);
        bool moved = false, stayed = false;
        mesh_.for_each_outgoing(split.vertex, [&](uint32_t out) { moved |= out != h && cut_[out] != 0; });
        mesh_.for_each_outgoing(split.into,
                                [&](uint32_t out) { stayed |= cut_[out] != 0 || mesh_.twin(out) == kNone; });
        const bool end =
            !stayed && int(left) + int(right) + count(split.vertex) == 1;  // an extremum stays at its vertex
        if (stayed || end) {
            // The merged edges stay with `into`; what moved hangs on by the edge between the two.
            if (left) set(next(h), 1);
            if (right) set(prev(t), 1);
            if (moved) set(h, 1);
        } else {
            if (left) set(prev(h), 1);
            if (right) set(next(t), 1);
        }
    }
    bool take(uint32_t h) {
        const bool marked = cut_[h] != 0 || (mesh_.twin(h) != kNone && cut_[mesh_.twin(h)] != 0);
        set(h, 0);
        return marked;
    }
    void set(uint32_t h, uint8_t value) {
        cut_[h] = value;
        if (mesh_.twin(h) != kNone) cut_[mesh_.twin(h)] = value;
    }
    int count(uint32_t v) const {
        int marked = 0;
        mesh_.for_each_outgoing(v, [&](uint32_t out) { marked += cut_[out] != 0; });
        return marked;
    }

    ProgressiveMesh& mesh_;
    CutEdges cut_;
};

}  // namespace

Result<FoundCut> find_cut(const Mesh& mesh, const Topology& topology, const AugmentOptions& options,
                          const Progress& progress) {
    ProgressiveMesh hierarchy(mesh);
    simplify(hierarchy, mesh.positions, {options.coarse_vertices, false, {}});
    const ProgressiveMesh::Compacted coarse = hierarchy.compact(mesh.positions);
    const Topology coarse_topology = build_topology(coarse.mesh);
    GIM_TRY(found, search({coarse.mesh, coarse_topology}, options, progress));

    CutEdges marks(topology.twin.size(), 0);
    for (size_t h = 0; h < found.cut.size(); ++h) marks[3 * coarse.faces[h / 3] + h % 3] = found.cut[h];
    for (AugmentStep& step : found.steps) {
        if (step.extremum != kNone) step.extremum = coarse.vertices[step.extremum];
    }
    found.cut = straighten_cut(mesh, topology, CutRefiner(hierarchy, std::move(marks)).run());
    if (!opens_to_disk(mesh, topology, found.cut)) {
        return Error{Stage::kCut, "the cut found on the coarse mesh does not open the full mesh into a disk"};
    }
    return std::move(found);
}

}  // namespace gim

#include "encoder/squares/augment_cut.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "encoder/base/result.h"
#include "encoder/squares/circle_map.h"
#include "encoder/squares/parametrize.h"
#include "encoder/surface/progressive_mesh.h"
#include "encoder/surface/stretch.h"

namespace gim {

namespace {

// The surface that the search runs on.
struct Surface {
    const Mesh& mesh;
    const Topology& topology;
};

// A cut and its map to the square. Efficiency and merit are 0 if no map was found.
struct State {
    CutEdges cut;
    double efficiency = 0;
    double merit = 0;        // efficiency, reduced by the price of cut-paths
    uint32_t worst = kNone;  // the vertex off the cut where this map stretches most
    std::vector<AugmentStep> steps;
};

// Returns the vertex off the cut that lies on the triangle of greatest stretch; kNone if there is none.
uint32_t most_stretched(const Surface& surface, const OpenedMesh& disk, const std::vector<Vec2>& uv,
                        const CutEdges& cut) {
    const std::vector<uint32_t> valence = cut_valence(surface.mesh, surface.topology, cut);
    uint32_t worst = kNone;
    double most = -1;
    for (const Triangle& t : disk.mesh.triangles) {
        const FaceMetric metric =
            face_metric(disk.mesh.positions[t[0]], disk.mesh.positions[t[1]], disk.mesh.positions[t[2]], 0);
        if (metric.weight == 0) continue;
        const double stretch = stretch_energy(metric, uv[t[0]], uv[t[1]], uv[t[2]]) / metric.weight;
        if (stretch <= most) continue;
        for (const uint32_t v : t) {
            const uint32_t source = disk.source[v];
            if (source == kNone || valence[source] != 0) continue;
            worst = source;
            most = stretch;
            break;
        }
    }
    return worst;
}

// Options of a map that is not quite at its optimum, in half of the time. It compares cuts as well.
ParametrizeOptions brief_map() {
    ParametrizeOptions brief;
    brief.growth = 1.4;
    brief.sweeps = 3;
    brief.final_sweeps = 8;
    brief.tolerance = 1e-3;
    return brief;
}

// Maps the surface to the square along the state's cut and rates the map.
void judge(const Surface& surface, const AugmentOptions& options, State& state) {
    state.efficiency = state.merit = 0;
    auto opened = open_mesh(surface.mesh, surface.topology, state.cut);
    if (!opened.ok()) return;
    auto laid = map_boundary(std::move(opened.value()), options.boundary);
    if (!laid.ok()) return;
    const SquareBoundary& boundary = laid.value();
    const auto uv =
        parametrize(boundary.opened.mesh, boundary.sides, boundary_uv(boundary, options.boundary.side), brief_map());
    if (!uv.ok()) return;
    state.efficiency = stretch_efficiency(boundary.opened.mesh, uv.value(), 1.0);
    state.merit = state.efficiency * std::exp(-options.path_cost * double(boundary.opened.paths.size()));
    state.worst = most_stretched(surface, boundary.opened, uv.value(), state.cut);
}

// Returns the vertex off the cut that lies on the triangle of greatest stretch under the circle map. kNone if every
// vertex is on the cut.
uint32_t find_extremum(const Surface& surface, const CutEdges& cut) {
    const auto opened = open_mesh(surface.mesh, surface.topology, cut);
    if (!opened.ok()) return kNone;
    const std::vector<Vec2> uv = circle_map(opened.value());
    return uv.empty() ? kNone : most_stretched(surface, opened.value(), uv, cut);
}

// Returns the vertex farthest from the cut, along edges.
uint32_t find_farthest(const Surface& surface, const CutEdges& cut) {
    std::vector<uint32_t> sources;
    const std::vector<uint32_t> valence = cut_valence(surface.mesh, surface.topology, cut);
    for (uint32_t v = 0; v < valence.size(); ++v) {
        if (valence[v] != 0) sources.push_back(v);
    }
    const std::vector<double> distance = edge_distance(surface.mesh, surface.topology, sources);
    const auto farthest = std::max_element(distance.begin(), distance.end());
    return *farthest > 0 ? static_cast<uint32_t>(farthest - distance.begin()) : kNone;
}

// Adds the shortest path from the cut to v.
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

// For closed surfaces of genus 0: starts again at the first extremum and cuts from there to the second.
CutEdges restart_at_extremum(const Surface& surface, const CutEdges& cut, std::vector<AugmentStep>& steps) {
    const uint32_t first = find_extremum(surface, cut);
    if (first == kNone) return cut;
    CutEdges bootstrap = edges_at(surface, first);
    const uint32_t second = find_extremum(surface, bootstrap);
    steps.push_back({0, first, bootstrap});
    if (second == kNone || second == first) return bootstrap;
    std::vector<uint8_t> goal(surface.mesh.positions.size(), 0);
    goal[first] = 1;
    const std::vector<uint32_t> path =
        shortest_path(surface.mesh, surface.topology, {second}, goal, std::vector<uint8_t>(goal.size(), 1));
    if (path.size() < 2) return bootstrap;
    CutEdges result(cut.size(), 0);
    mark_path(surface.topology, path, 1, result);
    steps.push_back({0, second, result});
    return result;
}

bool is_sphere(const Surface& surface) {
    const auto faces = static_cast<int64_t>(surface.mesh.triangles.size());
    const bool closed =
        std::none_of(surface.topology.twin.begin(), surface.topology.twin.end(), [](uint32_t t) { return t == kNone; });
    return closed && static_cast<int64_t>(surface.mesh.positions.size()) - faces / 2 == 2;
}

// The vertex that the next augmentation goes to.
enum class Aim {
    kCircleMap,  // greatest stretch under the circle map, as in the paper
    kSquareMap,  // greatest stretch under the current map to the square
    kFarthest,   // greatest distance from the cut
};

uint32_t pick(const Surface& surface, const State& state, Aim aim) {
    switch (aim) {
        case Aim::kCircleMap:
            return find_extremum(surface, state.cut);
        case Aim::kSquareMap:
            return state.worst;
        case Aim::kFarthest:
            return find_farthest(surface, state.cut);
    }
    return kNone;
}

// Follows one aim throughout and returns the best cut on the way.
State follow(const Surface& surface, const AugmentOptions& options, const State& start, Aim aim) {
    State best = start, trial = start;
    for (uint32_t i = 0, misses = 0; i < options.most_paths && misses < options.patience; ++i) {
        const uint32_t extremum = pick(surface, trial, aim);
        if (extremum == kNone) break;
        trial.cut = extend_cut(surface, trial.cut, extremum);
        judge(surface, options, trial);
        if (trial.efficiency == 0) break;  // more cut-paths than the ring can hold
        trial.steps.push_back({trial.efficiency, extremum, trial.cut});
        misses = trial.merit > best.merit ? 0 : misses + 1;
        if (misses == 0) best = trial;
    }
    return best;
}

// Returns faces spread over the surface, each far from those before it.
std::vector<uint32_t> spread_seeds(const Surface& surface, uint32_t count) {
    std::vector<uint32_t> seeds{0}, vertices{surface.mesh.triangles[0][0]};
    while (seeds.size() < count) {
        const std::vector<double> distance = edge_distance(surface.mesh, surface.topology, vertices);
        const auto v = static_cast<uint32_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
        vertices.push_back(v);
        seeds.push_back(face_of(surface.topology.outgoing[v]));
    }
    return seeds;
}

// Returns the best initial cut. Every seed gives one; on surfaces of higher genus they differ much.
State start_cut(const Surface& surface, const AugmentOptions& options) {
    const bool sphere = is_sphere(surface);
    const std::vector<uint32_t> seeds = spread_seeds(surface, sphere ? 1 : options.seeds);
    std::vector<State> states(seeds.size());
    tbb::parallel_for(size_t{0}, seeds.size(), [&](size_t i) {
        State& state = states[i];
        state.cut = initial_cut(surface.mesh, surface.topology, seeds[i]);
        if (sphere) {
            state.cut = restart_at_extremum(surface, state.cut, state.steps);
        } else {
            state.cut =
                straighten_cut(surface.mesh, surface.topology, shorten_cut(surface.mesh, surface.topology, state.cut));
        }
        judge(surface, options, state);
        state.steps.push_back({state.efficiency, kNone, state.cut});
    });
    return *std::max_element(states.begin(), states.end(),
                             [](const State& a, const State& b) { return a.merit < b.merit; });
}

// Every cut-path that is added needs more room. So nothing is left to search if the first cut has none.
Result<void> check_room_of(const Surface& surface, const AugmentOptions& options, const State& first) {
    if (first.efficiency > 0) return {};
    const auto opened = open_mesh(surface.mesh, surface.topology, first.cut);
    if (!opened.ok()) return {};
    return check_room(opened.value(), options.boundary);
}

// Follows every aim from the same start and keeps the best cut. Repeats this from there as long as it helps.
State search(const Surface& surface, const AugmentOptions& options, State best, const Progress& progress) {
    constexpr std::array<Aim, 3> kAims{Aim::kCircleMap, Aim::kSquareMap, Aim::kFarthest};
    for (double before = -1; best.merit > before;) {
        before = best.merit;
        std::array<State, kAims.size()> ends;
        tbb::parallel_for(size_t{0}, kAims.size(),
                          [&](size_t i) { ends[i] = follow(surface, options, best, kAims[i]); });
        for (State& end : ends) {
            if (end.merit > best.merit) best = std::move(end);
        }
        if (progress) progress(Stage::kCut, best.efficiency);
    }
    return best;
}

// Carries a cut of the coarse mesh to the full one. At every vertex split the cut stays the same curve, up to a slide
// across the faces that come back. It therefore still opens the surface into a disk.
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
        // The collapse merged edge vertex-left with into-left, and vertex-right with into-right. If the outer twin is
        // missing, the merged edge was an input boundary, which needs no mark.
        const bool left = take(prev(h)) | take(next(h)), right = take(next(t)) | take(prev(t));
        set(h, 0);
        bool moved = false, stayed = false;
        mesh_.for_each_outgoing(split.vertex, [&](uint32_t out) { moved |= out != h && cut_[out] != 0; });
        mesh_.for_each_outgoing(split.into,
                                [&](uint32_t out) { stayed |= cut_[out] != 0 || mesh_.twin(out) == kNone; });
        const bool end =
            !stayed && int(left) + int(right) + count(split.vertex) == 1;  // an extremum stays at its vertex
        if (stayed || end) {
            // The merged edges stay with `into`. The edge between the two connects them to what moved.
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

double mean_edge_length(const Mesh& mesh) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles) {
        for (size_t i = 0; i < 3; ++i) sum += (mesh.positions[t[i]] - mesh.positions[t[(i + 1) % 3]]).norm();
    }
    return sum / (3.0 * static_cast<double>(mesh.triangles.size()));
}

}  // namespace

CoarseSurface coarsen(const Mesh& mesh, uint32_t vertices) {
    ProgressiveMesh hierarchy(mesh);
    simplify(hierarchy, mesh.positions, {vertices, false, {}});
    ProgressiveMesh::Compacted compacted = hierarchy.compact(mesh.positions);
    Topology topology = build_topology(compacted.mesh);
    return {std::move(hierarchy), std::move(compacted), std::move(topology)};
}

Result<FoundCut> find_cut(const Mesh& mesh, const Topology& topology, const CoarseSurface& surface,
                          const AugmentOptions& options, const Progress& progress) {
    const ProgressiveMesh::Compacted& coarse = surface.compacted;
    const Surface searched{coarse.mesh, surface.topology};
    State first = start_cut(searched, options);
    GIM_CHECK(check_room_of(searched, options, first));
    State state = search(searched, options, std::move(first), progress);
    FoundCut found{std::move(state.cut), std::move(state.steps), coarse.mesh};

    CutEdges marks(topology.twin.size(), 0);
    for (size_t h = 0; h < found.cut.size(); ++h) marks[3 * coarse.faces[h / 3] + h % 3] = found.cut[h];
    StraightenOptions straighten;
    straighten.widest = 2 * mean_edge_length(coarse.mesh);
    for (AugmentStep& step : found.steps) {
        if (step.extremum == kNone) continue;
        step.extremum = coarse.vertices[step.extremum];
        straighten.fixed.push_back(step.extremum);
    }
    ProgressiveMesh hierarchy = surface.hierarchy;
    found.cut = straighten_cut(mesh, topology, CutRefiner(hierarchy, std::move(marks)).run(), straighten);
    if (!opens_to_disk(mesh, topology, found.cut)) {
        return Error{Stage::kCut, "the cut found on the coarse mesh does not open the full mesh into a disk"};
    }
    return found;
}

}  // namespace gim

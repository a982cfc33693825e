#include "encoder/surface/sharp_lines.h"

#include <cmath>

#include "encoder/base/disjoint_sets.h"

namespace gim {

namespace {

// Connected sharp edges have at least this length, in bounding-box diagonals of the component, if they have loose ends
// or if they have none, and so many edges for each loose end.
constexpr double kLeastLength = 0.25, kLeastLoop = 0.02;
constexpr uint32_t kEdgesPerEnd = 4;

// Sums over connected edges: the vertex that stands for them has the values.
struct Sums {
    DisjointSets sets;
    std::vector<double> length;
    std::vector<uint32_t> edges, ends;

    explicit Sums(size_t vertices) : sets(vertices), length(vertices), edges(vertices), ends(vertices) {}
};

// Returns the bounding-box diagonal of each component, at the vertex that stands for it.
std::vector<double> diagonals(const Mesh& mesh, DisjointSets& surfaces) {
    const size_t count = mesh.positions.size();
    std::vector<Vec3> low(count, Vec3::Constant(HUGE_VAL)), high(count, Vec3::Constant(-HUGE_VAL));
    for (uint32_t v = 0; v < count; ++v) {
        const uint32_t s = surfaces.find(v);
        low[s] = low[s].cwiseMin(mesh.positions[v]);
        high[s] = high[s].cwiseMax(mesh.positions[v]);
    }
    std::vector<double> result(count);
    for (uint32_t v = 0; v < count; ++v) result[v] = (high[v] - low[v]).norm();
    return result;
}

}  // namespace

void drop_short_lines(const Mesh& mesh, const Topology& topology, std::vector<bool>& sharp) {
    Sums lines(mesh.positions.size());
    DisjointSets surfaces(mesh.positions.size());
    std::vector<uint32_t> degree(mesh.positions.size(), 0);
    const auto is_owner = [&](uint32_t h) { return topology.twin[h] != kNone && h < topology.twin[h]; };
    for (uint32_t h = 0; h < sharp.size(); ++h) {
        surfaces.unite(from(mesh, h), to(mesh, h));
        if (!sharp[h] || !is_owner(h)) continue;
        lines.sets.unite(from(mesh, h), to(mesh, h));
        ++degree[from(mesh, h)];
        ++degree[to(mesh, h)];
    }
    for (uint32_t v = 0; v < degree.size(); ++v) lines.ends[lines.sets.find(v)] += degree[v] == 1;
    for (uint32_t h = 0; h < sharp.size(); ++h) {
        if (!sharp[h] || !is_owner(h)) continue;
        const uint32_t line = lines.sets.find(from(mesh, h));
        ++lines.edges[line];
        lines.length[line] += (mesh.positions[to(mesh, h)] - mesh.positions[from(mesh, h)]).norm();
    }
    const std::vector<double> diagonal = diagonals(mesh, surfaces);
    for (uint32_t h = 0; h < sharp.size(); ++h) {
        if (!sharp[h]) continue;
        const uint32_t line = lines.sets.find(from(mesh, h));
        const double least =
            (lines.ends[line] > 0 ? kLeastLength : kLeastLoop) * diagonal[surfaces.find(from(mesh, h))];
        sharp[h] = lines.length[line] >= least && lines.edges[line] >= kEdgesPerEnd * lines.ends[line];
    }
}

}  // namespace gim

#include "encoder/tiles/base_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "encoder/tiles/crease_graph.h"
#include "encoder/tiles/decimator.h"

namespace gim {

namespace {

Vec3 face_normal(const Mesh& mesh, uint32_t f) {
    const Triangle& t = mesh.triangles[f];
    return (mesh.positions[t[1]] - mesh.positions[t[0]]).cross(mesh.positions[t[2]] - mesh.positions[t[0]]);
}

// Returns per vertex the base vertex that it has moved to.
std::vector<uint32_t> representatives(size_t vertices, const std::vector<HalfEdgeCollapse>& collapses) {
    std::vector<uint32_t> into(vertices);
    std::iota(into.begin(), into.end(), 0u);
    for (size_t i = collapses.size(); i-- > 0;) into[collapses[i].vertex] = into[collapses[i].into];
    return into;
}

}  // namespace

std::vector<bool> find_creases(const Mesh& mesh, double angle) {
    const Topology topology = build_topology(mesh);
    std::vector<bool> sharp(topology.twin.size(), false);
    for (uint32_t h = 0; h < sharp.size(); ++h) {
        const uint32_t t = topology.twin[h];
        if (t == kNone) continue;
        const Vec3 a = face_normal(mesh, face_of(h)), b = face_normal(mesh, face_of(t));
        const double lengths = a.norm() * b.norm();
        sharp[h] = lengths > 0 && std::atan2(a.cross(b).norm(), a.dot(b)) >= angle;
    }
    return sharp;
}

BaseHierarchy::BaseHierarchy(const Mesh& mesh, const std::vector<bool>& sharp) : sharp_(sharp) {
    Decimator decimator(mesh, sharp, vertex_shares(mesh, sharp));
    decimator.run(0);
    collapses_ = decimator.collapses();
    removed_by_ = decimator.removed_by();
    well_shaped_ = decimator.made_by(Rules::kAll);
    with_all_creases_ = decimator.made_by(Rules::kLooseShape);
}

uint32_t BaseHierarchy::collapses_down_to(uint32_t faces) const {
    auto left = static_cast<uint32_t>(removed_by_.size());
    uint32_t count = 0;
    for (; count < collapses_.size() && left > faces; ++count)
        left -= (collapses_[count].left != kNone) + (collapses_[count].right != kNone);
    return count;
}

BaseMesh BaseHierarchy::cut(const Mesh& mesh, uint32_t count) const {
    return base_after(mesh, sharp_, {collapses_.begin(), collapses_.begin() + count}, removed_by_);
}

BaseMesh base_after(const Mesh& mesh, const std::vector<bool>& sharp, std::vector<HalfEdgeCollapse> collapses,
                    const std::vector<uint32_t>& removed_by) {
    BaseMesh base;
    const std::vector<uint32_t> into = representatives(mesh.positions.size(), collapses);
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        if (removed_by[f] >= collapses.size()) base.triangles.push_back({into[t[0]], into[t[1]], into[t[2]]});
    }
    CreaseGraph creases(mesh, sharp);
    for (const HalfEdgeCollapse& c : collapses) creases.collapse(c);
    base.creases = creases.edges();
    creases.undo_all();
    base.kinds = creases.kinds();
    base.collapses = std::move(collapses);
    return base;
}

}  // namespace gim

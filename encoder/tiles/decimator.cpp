#include "encoder/tiles/decimator.h"

#include "encoder/base/disjoint_sets.h"

namespace gim {

using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

namespace {

// The cube is the smallest sphere of quads in which at least three meet at each vertex. A disk can be one quad.
constexpr uint32_t kLeastSphere = 12, kLeastDisk = 2;

}  // namespace

Decimator::Decimator(const Mesh& mesh, const std::vector<bool>& sharp, std::vector<VertexShare> shares,
                     std::vector<uint32_t> seeds)
    : mesh_(mesh, sharp),
      shares_(std::move(shares)),
      seeds_(std::move(seeds)),
      costs_(mesh_, shares_, seeds_),
      version_(mesh.positions.size(), 0),
      removed_by_(mesh.triangles.size(), kNone),
      faces_(static_cast<uint32_t>(mesh.triangles.size())) {
    find_floors();
}

void Decimator::find_floors() {
    DisjointSets sets(mesh_.n_vertices());
    for (const EdgeHandle e : mesh_.edges()) {
        const HalfedgeHandle h = mesh_.halfedge_handle(e, 0);
        sets.unite(index(mesh_.from_vertex_handle(h)), index(mesh_.to_vertex_handle(h)));
    }
    component_.resize(mesh_.n_vertices());
    std::vector<int64_t> euler(mesh_.n_vertices(), 0);
    std::vector<bool> open(mesh_.n_vertices(), false);
    component_faces_.assign(mesh_.n_vertices(), 0);
    for (const VertexHandle v : mesh_.vertices()) {
        const uint32_t c = component_[index(v)] = sets.find(index(v));
        ++euler[c];
        if (mesh_.is_boundary(v)) open[c] = true;
    }
    for (const EdgeHandle e : mesh_.edges())
        --euler[component_[index(mesh_.to_vertex_handle(mesh_.halfedge_handle(e, 0)))]];
    for (const FaceHandle f : mesh_.faces()) {
        const uint32_t c = component_[index(mesh_.to_vertex_handle(mesh_.halfedge_handle(f)))];
        ++euler[c];
        ++component_faces_[c];
    }
    floor_.assign(mesh_.n_vertices(), 0);
    for (uint32_t c = 0; c < floor_.size(); ++c) {
        if (euler[c] == 2) floor_[c] = kLeastSphere;
        if (euler[c] == 1 && open[c]) floor_[c] = kLeastDisk;
    }
}

bool Decimator::above_floor(HalfedgeHandle h) const {
    const uint32_t c = component_[index(mesh_.from_vertex_handle(h))];
    const uint32_t gone = mesh_.is_boundary(mesh_.edge_handle(h)) ? 1 : 2;
    return component_faces_[c] >= floor_[c] + gone;
}

void Decimator::run(uint32_t faces) {
    for (const Rules rules : {Rules::kAll, Rules::kLooseShape, Rules::kTopology}) {
        run_by(rules, faces);
        made_by_[static_cast<size_t>(rules)] = static_cast<uint32_t>(collapses_.size());
    }
}

void Decimator::run_by(Rules rules, uint32_t faces) {
    queue_ = {};
    for (const VertexHandle v : mesh_.vertices()) push(v, rules);
    while (faces_ > faces && !queue_.empty()) {
        const Entry entry = queue_.top();
        queue_.pop();
        const VertexHandle v = mesh_.vertex_handle(entry.vertex);
        if (entry.version != version_[entry.vertex] || mesh_.status(v).deleted()) continue;
        const CollapseCost::Candidate now = costs_.best(v, rules);  // vertices farther away may have changed since
        if (!now.edge.is_valid() || !above_floor(now.edge)) continue;
        if (now.cost > entry.cost * (1 + 1e-9)) {
            queue_.push({now.cost, entry.vertex, ++version_[entry.vertex]});
            continue;
        }
        const VertexHandle into = mesh_.to_vertex_handle(now.edge);
        collapse(now.edge);
        push_around(into, rules);
    }
}

void Decimator::push(VertexHandle v, Rules rules) {
    if (mesh_.status(v).deleted() || mesh_.is_isolated(v)) return;
    const CollapseCost::Candidate candidate = costs_.best(v, rules);
    ++version_[index(v)];
    if (candidate.edge.is_valid()) queue_.push({candidate.cost, index(v), version_[index(v)]});
}

void Decimator::push_around(VertexHandle v, Rules rules) {
    push(v, rules);
    for (auto w = mesh_.vv_begin(v); w.is_valid(); ++w) push(*w, rules);
}

void Decimator::collapse(uint32_t vertex, uint32_t into) {
    collapse(mesh_.find_halfedge(mesh_.vertex_handle(vertex), mesh_.vertex_handle(into)));
}

std::optional<double> Decimator::cost_of(HalfedgeHandle h) {
    return above_floor(h) ? costs_.cost_of(h, Rules::kLooseShape) : std::nullopt;
}

// A crease goes along only where its vertex moves along it. A corner, or a vertex that leaves its crease, ends it.
void Decimator::drop_creases(HalfedgeHandle h) {
    const VertexHandle v = mesh_.from_vertex_handle(h);
    if (mesh_.feature_count(v) == 2 && mesh_.is_feature(mesh_.edge_handle(h))) return;
    std::vector<HalfedgeHandle> outgoing;
    mesh_.outgoing(v, outgoing);
    for (const HalfedgeHandle out : outgoing) {
        if (mesh_.is_crease(mesh_.edge_handle(out))) mesh_.drop_crease(mesh_.edge_handle(out));
    }
}

void Decimator::collapse(HalfedgeHandle h) {
    const VertexHandle vertex = mesh_.from_vertex_handle(h), into = mesh_.to_vertex_handle(h);
    const HalfedgeHandle back = mesh_.opposite_halfedge_handle(h);
    const auto corner = [&](HalfedgeHandle side) {
        return mesh_.is_boundary(side) ? kNone : index(mesh_.opposite_corner(side));
    };
    for (const HalfedgeHandle side : {h, back}) {
        if (mesh_.is_boundary(side)) continue;
        removed_by_[index(mesh_.face_handle(side))] = static_cast<uint32_t>(collapses_.size());
        --faces_;
        --component_faces_[component_[index(vertex)]];
    }
    collapses_.push_back({index(vertex), index(into), corner(h), corner(back)});
    damage_ += costs_.damage(h);
    drop_creases(h);
    mesh_.collapse_keeping_creases(h);
    shares_[index(into)] += shares_[index(vertex)];
}

}  // namespace gim

#include "encoder/tiles/tile_base.h"

#include <algorithm>
#include <numeric>

#include "encoder/surface/topology_summary.h"
#include "encoder/tiles/part_base.h"

namespace gim {

namespace {

// Faces of a component at the fine cut, against those at the wanted one. Flat faces between creases and boundaries lose
// their inner vertices early, and those decide how they can be paired.
constexpr uint32_t kFineFactor = 2, kFineFaces = 24, kFineFactorWithLines = 5, kFineFacesWithLines = 100;

// The collapses of all components, and where the fine cut through each is.
class FineCut {
  public:
    FineCut(const TileInput& input, const BaseHierarchy& hierarchy, uint32_t count);

    PartMesh part(uint32_t component) const;
    // Number of the part's collapses before the wanted cut.
    uint32_t part_count(uint32_t component) const {
        return static_cast<uint32_t>(wanted_[component] - fine_[component]);
    }
    // Takes over what was chosen for a component.
    void add(uint32_t component, const PartBase& chosen);
    uint32_t component_count() const { return static_cast<uint32_t>(lists_.size()); }
    BaseMesh base() const { return base_after(input_.mesh, input_.sharp, collapses_, removed_by_); }

  private:
    void choose_cuts(uint32_t count);
    void keep_fine_collapses();
    void number_parts();

    const TileInput& input_;
    const BaseHierarchy& hierarchy_;
    Components components_;
    std::vector<uint32_t> component_of_;        // per vertex
    std::vector<std::vector<uint32_t>> lists_;  // per component its collapses in the hierarchy
    std::vector<size_t> fine_, wanted_;         // per component: how many of them precede the cuts
    std::vector<HalfEdgeCollapse> collapses_;   // of the result
    std::vector<uint32_t> removed_by_;
    BaseMesh base_;                             // at the fine cut
    std::vector<VertexShare> shares_;           // of its vertices
    std::vector<std::vector<uint32_t>> faces_;  // per component: input faces of the fine cut, and triangles of base_
    std::vector<std::vector<uint32_t>> triangles_;
    std::vector<std::vector<uint32_t>> vertices_;  // per component
    std::vector<uint32_t> number_;                 // per vertex of the fine cut: its place in vertices_
};

FineCut::FineCut(const TileInput& input, const BaseHierarchy& hierarchy, uint32_t count)
    : input_(input),
      hierarchy_(hierarchy),
      components_(connected_components(input.mesh.triangles, input.mesh.positions.size())),
      component_of_(input.mesh.positions.size(), kNone),
      lists_(components_.count) {
    for (uint32_t f = 0; f < input.mesh.triangles.size(); ++f) {
        for (const uint32_t v : input.mesh.triangles[f]) component_of_[v] = components_.of_face[f];
    }
    for (uint32_t i = 0; i < hierarchy.collapses().size(); ++i)
        lists_[component_of_[hierarchy.collapses()[i].vertex]].push_back(i);
    choose_cuts(count);
    keep_fine_collapses();
    number_parts();
}

void FineCut::choose_cuts(uint32_t count) {
    std::vector<uint32_t> faces(lists_.size(), 0);
    for (const uint32_t c : components_.of_face) ++faces[c];
    std::vector<bool> lines(lists_.size(), false);
    const Topology topology = build_topology(input_.mesh);
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        if (topology.twin[h] == kNone || (!input_.sharp.empty() && input_.sharp[h]))
            lines[components_.of_face[face_of(h)]] = true;
    }
    const auto gone = [&](uint32_t collapse) {
        const HalfEdgeCollapse& c = hierarchy_.collapses()[collapse];
        return uint32_t{c.left != kNone} + uint32_t{c.right != kNone};
    };
    for (size_t c = 0; c < lists_.size(); ++c) {
        const std::vector<uint32_t>& list = lists_[c];
        size_t at = static_cast<size_t>(std::lower_bound(list.begin(), list.end(), count) - list.begin());
        wanted_.push_back(at);
        for (size_t i = 0; i < at; ++i) faces[c] -= gone(list[i]);
        const uint32_t fine =
            lines[c] ? kFineFactorWithLines * faces[c] + kFineFacesWithLines : kFineFactor * faces[c] + kFineFaces;
        while (at > 0 && faces[c] < fine) faces[c] += gone(list[--at]);
        fine_.push_back(at);
    }
}

void FineCut::keep_fine_collapses() {
    const std::vector<HalfEdgeCollapse>& all = hierarchy_.collapses();
    std::vector<uint32_t> place(all.size(), kNone);
    for (uint32_t i = 0; i < all.size(); ++i) {
        const uint32_t c = component_of_[all[i].vertex];
        if (fine_[c] < lists_[c].size() && i >= lists_[c][fine_[c]]) continue;
        place[i] = static_cast<uint32_t>(collapses_.size());
        collapses_.push_back(all[i]);
    }
    for (const uint32_t by : hierarchy_.removed_by()) removed_by_.push_back(by == kNone ? kNone : place[by]);
    base_ = base_after(input_.mesh, input_.sharp, collapses_, removed_by_);
}

void FineCut::number_parts() {
    faces_.resize(lists_.size());
    triangles_.resize(lists_.size());
    vertices_.resize(lists_.size());
    number_.assign(component_of_.size(), kNone);
    uint32_t triangle = 0;
    for (uint32_t f = 0; f < removed_by_.size(); ++f) {
        if (removed_by_[f] != kNone) continue;
        const uint32_t c = components_.of_face[f];
        faces_[c].push_back(f);
        triangles_[c].push_back(triangle);
        for (const uint32_t v : base_.triangles[triangle++]) {
            if (number_[v] != kNone) continue;
            number_[v] = static_cast<uint32_t>(vertices_[c].size());
            vertices_[c].push_back(v);
        }
    }
    shares_ = vertex_shares(input_.mesh, input_.sharp);
    for (const HalfEdgeCollapse& c : collapses_) shares_[c.into] += shares_[c.vertex];
}

PartMesh FineCut::part(uint32_t component) const {
    PartMesh part;
    for (const uint32_t v : vertices_[component]) {
        part.mesh.positions.push_back(input_.mesh.positions[v]);
        part.shares.push_back(shares_[v]);
    }
    for (const uint32_t t : triangles_[component]) {
        const Triangle& corners = base_.triangles[t];
        for (uint32_t i = 0; i < 3; ++i) {
            const uint32_t a = corners[i], b = corners[(i + 1) % 3];
            const std::array<uint32_t, 2> edge{std::min(a, b), std::max(a, b)};
            part.sharp.push_back(std::binary_search(base_.creases.begin(), base_.creases.end(), edge));
        }
        part.mesh.triangles.push_back({number_[corners[0]], number_[corners[1]], number_[corners[2]]});
    }
    const std::vector<uint32_t>& list = lists_[component];
    for (size_t i = fine_[component]; i < wanted_[component]; ++i) {
        const HalfEdgeCollapse& c = hierarchy_.collapses()[list[i]];
        const auto number = [&](uint32_t v) { return v == kNone ? kNone : number_[v]; };
        part.collapses.push_back({number(c.vertex), number(c.into), number(c.left), number(c.right)});
    }
    return part;
}

void FineCut::add(uint32_t component, const PartBase& chosen) {
    const auto before = static_cast<uint32_t>(collapses_.size());
    const auto original = [&](uint32_t v) { return v == kNone ? kNone : vertices_[component][v]; };
    for (const HalfEdgeCollapse& c : chosen.collapses)
        collapses_.push_back({original(c.vertex), original(c.into), original(c.left), original(c.right)});
    for (size_t i = 0; i < chosen.removed_by.size(); ++i) {
        if (chosen.removed_by[i] != kNone) removed_by_[faces_[component][i]] = before + chosen.removed_by[i];
    }
}

}  // namespace

TileBase make_tile_base(const TileInput& input, const BaseHierarchy& hierarchy, uint32_t triangles) {
    FineCut cut(input, hierarchy, hierarchy.collapses_down_to(triangles));
    for (uint32_t c = 0; c < cut.component_count(); ++c) cut.add(c, choose_part_base(cut.part(c), cut.part_count(c)));
    TileBase result{cut.base(), {}};
    result.pairing = pair_triangles(input.mesh.positions, result.base);
    return result;
}

}  // namespace gim

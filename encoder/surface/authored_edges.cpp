#include "encoder/surface/authored_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "encoder/base/disjoint_sets.h"
#include "encoder/surface/sharp_edges.h"
#include "encoder/surface/sharp_lines.h"
#include "encoder/surface/topology_summary.h"

namespace gim {

namespace {

// All angles are in degrees.
// Normals break by more than rounding if they differ by this, and edges are bent if their faces do.
constexpr double kBreaks = 1.5, kBent = 2;
// An edge is hard if its normals differ by this; its line stays if it bends the surface by the other one on average.
constexpr float kHardBreak = 5;
constexpr double kLeastBend = 10;
// Shading is flat if so many of the bent edges are broken. Or so many of the vertices on bent edges have broken edges on
// three sides or more: bent edges inside the polygons of a file are not broken.
constexpr double kFlatEdges = 0.95, kFlatVertices = 0.9;
// Lines may fork and end at so many vertices, as many as a base has, or else at this part of their vertices.
constexpr uint32_t kMostKnots = 100;
constexpr double kKnottedPart = 0.25;
// Of the hard edges that bend the surface, at least this part, by length, forms long lines. Less is chance.
constexpr double kLeastPart = 0.25;

class Reader {
  public:
    Reader(const Mesh& mesh, const std::vector<float>& breaks)
        : mesh_(mesh),
          breaks_(breaks),
          topology_(build_topology(mesh)),
          components_(connected_components(mesh.triangles, mesh.positions.size())),
          component_of_(mesh.positions.size(), 0) {
        for (uint32_t h = 0; h < breaks.size(); ++h) component_of_[from(mesh, h)] = components_.of_face[face_of(h)];
    }

    AuthoredEdges read() {
        std::vector<bool> named(breaks_.size());
        for (uint32_t h = 0; h < named.size(); ++h) named[h] = topology_.twin[h] != kNone && breaks_[h] >= kHardBreak;
        std::vector<bool> lines = named;
        drop_gentle_lines(lines);
        const std::vector<double> before = lengths(lines);
        drop_short_lines(mesh_, topology_, lines);
        const std::vector<double> after = lengths(lines);
        const std::vector<bool> is_flat = find_flat(), is_knotted = find_knotted(lines);

        AuthoredEdges authored;
        authored.words.assign(breaks_.size(), EdgeWord::kNothing);
        for (uint32_t h = 0; h < breaks_.size(); ++h) {
            const uint32_t c = components_.of_face[face_of(h)];
            if (is_flat[c] || is_knotted[c] || after[c] < kLeastPart * before[c]) continue;
            authored.words[h] = lines[h] ? EdgeWord::kHard : EdgeWord::kSmooth;
            authored.named += is_owner(h) && named[h];
            authored.kept += is_owner(h) && lines[h];
        }
        return authored.kept > 0 ? authored : AuthoredEdges{};
    }

  private:
    bool is_owner(uint32_t h) const { return topology_.twin[h] != kNone && h < topology_.twin[h]; }
    double length_of(uint32_t h) const {
        return (mesh_.positions[to(mesh_, h)] - mesh_.positions[from(mesh_, h)]).norm();
    }

    Vec3 normal_of(uint32_t f) const {
        const Triangle& t = mesh_.triangles[f];
        const Vec3& a = mesh_.positions[t[0]];
        return (mesh_.positions[t[1]] - a).cross(mesh_.positions[t[2]] - a).stableNormalized();
    }
    double bend_at(uint32_t h) const {
        const Vec3 a = normal_of(face_of(h)), b = normal_of(face_of(topology_.twin[h]));
        return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
    }

    // Length of the marked edges of each component.
    std::vector<double> lengths(const std::vector<bool>& marked) const {
        std::vector<double> length(components_.count, 0);
        for (uint32_t h = 0; h < marked.size(); ++h) {
            if (marked[h] && is_owner(h)) length[components_.of_face[face_of(h)]] += length_of(h);
        }
        return length;
    }

    // Number of marked edges at each vertex.
    std::vector<uint32_t> degrees(const std::vector<bool>& marked) const {
        std::vector<uint32_t> degree(mesh_.positions.size(), 0);
        for (uint32_t h = 0; h < marked.size(); ++h) {
            if (!marked[h] || !is_owner(h)) continue;
            ++degree[from(mesh_, h)];
            ++degree[to(mesh_, h)];
        }
        return degree;
    }

    // Drops lines between forks that bend the surface, or its normals, too little on average.
    void drop_gentle_lines(std::vector<bool>& hard) const {
        const std::vector<uint32_t> degree = degrees(hard);
        DisjointSets lines(hard.size());  // of half-edges that stand for edges
        std::vector<uint32_t> first(mesh_.positions.size(), kNone);
        for (uint32_t h = 0; h < hard.size(); ++h) {
            if (!hard[h] || !is_owner(h)) continue;
            for (const uint32_t v : {from(mesh_, h), to(mesh_, h)}) {
                if (degree[v] != 2) continue;
                if (first[v] != kNone) lines.unite(first[v], h);
                first[v] = h;
            }
        }
        std::vector<double> length(hard.size(), 0), bend(hard.size(), 0);
        for (uint32_t h = 0; h < hard.size(); ++h) {
            if (!hard[h] || !is_owner(h)) continue;
            length[lines.find(h)] += length_of(h);
            bend[lines.find(h)] += length_of(h) * std::min(bend_at(h), double{breaks_[h]});
        }
        for (uint32_t h = 0; h < hard.size(); ++h) {
            if (!hard[h] || !is_owner(h)) continue;
            const uint32_t line = lines.find(h);
            if (!(bend[line] >= kLeastBend * length[line])) hard[h] = hard[topology_.twin[h]] = false;
        }
    }

    // Per component whether its shading is flat. For vertices, a boundary is broken: it takes one side of them.
    std::vector<bool> find_flat() const {
        std::vector<uint32_t> broken(mesh_.positions.size(), 0);
        std::vector<uint8_t> is_bent(mesh_.positions.size(), 0);
        std::vector<uint32_t> bent_edges(components_.count, 0), broken_edges(components_.count, 0);
        for (uint32_t h = 0; h < breaks_.size(); ++h) {
            const bool is_boundary = topology_.twin[h] == kNone;
            if (!is_boundary && !is_owner(h)) continue;
            const bool breaks = is_boundary || breaks_[h] > kBreaks, bends = !is_boundary && bend_at(h) > kBent;
            const uint32_t c = components_.of_face[face_of(h)];
            bent_edges[c] += bends;
            broken_edges[c] += bends && breaks;
            for (const uint32_t v : {from(mesh_, h), to(mesh_, h)}) {
                broken[v] += breaks;
                is_bent[v] |= static_cast<uint8_t>(bends);
            }
        }
        std::vector<uint32_t> bent(components_.count, 0), surrounded(components_.count, 0);
        for (uint32_t v = 0; v < broken.size(); ++v) {
            if (is_bent[v] == 0) continue;
            ++bent[component_of_[v]];
            surrounded[component_of_[v]] += broken[v] >= 3;
        }
        std::vector<bool> is_flat;
        for (uint32_t c = 0; c < components_.count; ++c)
            is_flat.push_back(broken_edges[c] > kFlatEdges * bent_edges[c] || surrounded[c] > kFlatVertices * bent[c]);
        return is_flat;
    }

    // Per component whether its lines fork or end nearly everywhere.
    std::vector<bool> find_knotted(const std::vector<bool>& lines) const {
        const std::vector<uint32_t> degree = degrees(lines);
        std::vector<uint32_t> on_lines(components_.count, 0), knots(components_.count, 0);
        for (uint32_t v = 0; v < degree.size(); ++v) {
            on_lines[component_of_[v]] += degree[v] > 0;
            knots[component_of_[v]] += degree[v] > 0 && degree[v] != 2;
        }
        std::vector<bool> is_knotted;
        for (uint32_t c = 0; c < components_.count; ++c)
            is_knotted.push_back(knots[c] > kMostKnots && knots[c] > kKnottedPart * on_lines[c]);
        return is_knotted;
    }

    const Mesh& mesh_;
    const std::vector<float>& breaks_;
    Topology topology_;
    Components components_;
    std::vector<uint32_t> component_of_;  // per vertex
};

}  // namespace

AuthoredEdges read_authored_edges(const Mesh& mesh, const std::vector<float>& breaks) {
    const bool has_hard = std::any_of(breaks.begin(), breaks.end(), [](float b) { return b >= kHardBreak; });
    return has_hard ? Reader(mesh, breaks).read() : AuthoredEdges{};
}

std::vector<bool> creases_of(const Mesh& mesh, const AuthoredEdges& authored) {
    const std::vector<EdgeWord>& words = authored.words;
    const bool is_complete = !words.empty() && std::find(words.begin(), words.end(), EdgeWord::kNothing) == words.end();
    std::vector<bool> sharp = is_complete ? std::vector<bool>(words.size()) : sharp_edges(mesh);
    for (size_t h = 0; h < words.size(); ++h) {
        if (words[h] != EdgeWord::kNothing) sharp[h] = words[h] == EdgeWord::kHard;
    }
    return sharp;
}

}  // namespace gim

// Cleans input meshes (clean.h). Not from a paper: layouts need oriented 2-manifolds, and files do not promise them.
//
// Order: check the numbers; drop degenerate and duplicate triangles; weld boundary edges that lie exactly on each
// other; check that the surface is what clean.h promises, and if not, say where; orient; drop unreferenced vertices.
#include "encoder/surface/clean.h"
#include "encoder/base/result.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "encoder/base/disjoint_sets.h"

namespace gim {

namespace {

using Point = std::array<double, 3>;

constexpr size_t kListed = 3;  // most elements that a message describes

Error error(std::string message) { return Error{Stage::kClean, std::move(message)}; }

std::string count_of(uint64_t n, const char* one, const char* many) {
    return std::to_string(n) + " " + (n == 1 ? one : many);
}

std::string text_of(const Point& p) {
    std::array<char, 96> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "(%.6g, %.6g, %.6g)", p[0], p[1], p[2]);
    return buffer.data();
}

// ---- numbers --------------------------------------------------------------------------------------------------------

Result<void> check_numbers(const TriangleMesh& input) {
    if (input.triangles.empty()) return error("the mesh has no triangles; is the file a point cloud, or empty?");
    if (input.positions.size() >= kNone / 4 || input.triangles.size() >= kNone / 4) {
        return error("the mesh is too large: " + std::to_string(input.triangles.size()) +
                     " triangles; simplify it first");
    }
    uint64_t bad = 0;
    size_t first_bad = 0;
    for (size_t v = input.positions.size(); v-- > 0;) {
        const Point& p = input.positions[v];
        if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) continue;
        ++bad;
        first_bad = v;
    }
    if (bad > 0) {
        return error(count_of(bad, "vertex has", "vertices have") +
                     " coordinates that are not finite numbers, the first is vertex " + std::to_string(first_bad) +
                     " at " + text_of(input.positions[first_bad]) + "; repair or remove them");
    }
    for (size_t f = input.triangles.size(); f-- > 0;) {
        for (const uint32_t v : input.triangles[f]) {
            if (v < input.positions.size()) continue;
            ++bad;
            first_bad = f;
            break;
        }
    }
    if (bad > 0) {
        const Triangle& t = input.triangles[first_bad];
        return error(count_of(bad, "triangle uses", "triangles use") +
                     " vertices that do not exist, the first is triangle " + std::to_string(first_bad) + " (" +
                     std::to_string(t[0]) + ", " + std::to_string(t[1]) + ", " + std::to_string(t[2]) +
                     ") of a mesh of " + std::to_string(input.positions.size()) + " vertices; the file is damaged");
    }
    return {};
}

// ---- degenerate and duplicate triangles -----------------------------------------------------------------------------

Triangle sorted(Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
}

// Removes triangles that repeat a name, or have the same three names as an earlier triangle. `considered` says which
// triangles may be removed. Names are vertices or places.
template <class NameOf, class Considered>
void remove_useless(std::vector<Triangle>& triangles, CleanReport& report, const NameOf& name_of,
                    const Considered& considered) {
    std::vector<std::pair<Triangle, uint32_t>> keys(triangles.size());
    for (uint32_t f = 0; f < triangles.size(); ++f) {
        const Triangle& t = triangles[f];
        keys[f] = {sorted({name_of(t[0]), name_of(t[1]), name_of(t[2])}), f};
    }
    std::vector<bool> removed(triangles.size(), false);
    const auto remove = [&](uint32_t f, uint64_t& counter) {
        if (removed[f] || !considered(f)) return;
        removed[f] = true;
        ++counter;
    };
    for (const auto& [key, f] : keys) {
        if (key[0] == key[1] || key[1] == key[2]) remove(f, report.degenerate_triangles);
    }
    std::sort(keys.begin(), keys.end());
    for (size_t k = 1; k < keys.size(); ++k) {
        if (keys[k].first == keys[k - 1].first) remove(keys[k].second, report.duplicate_triangles);
    }
    size_t kept = 0;
    for (uint32_t f = 0; f < triangles.size(); ++f) {
        if (!removed[f]) triangles[kept++] = triangles[f];
    }
    triangles.resize(kept);
}

void remove_useless(std::vector<Triangle>& triangles, CleanReport& report) {
    remove_useless(
        triangles, report, [](uint32_t v) { return v; }, [](uint32_t) { return true; });
}

// ---- welding --------------------------------------------------------------------------------------------------------

// Numbers the vertices so that equal positions, and only they, share a number.
std::vector<uint32_t> number_places(const std::vector<Point>& positions) {
    std::vector<uint32_t> order(positions.size());
    for (uint32_t v = 0; v < order.size(); ++v) order[v] = v;
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return positions[a] != positions[b] ? positions[a] < positions[b] : a < b;
    });
    std::vector<uint32_t> place(positions.size());
    for (size_t k = 0; k < order.size(); ++k) {
        const bool same = k > 0 && positions[order[k]] == positions[order[k - 1]];
        place[order[k]] = same ? place[order[k - 1]] : order[k];
    }
    return place;
}

// Returns for each triangle whether all its three edges are boundary edges, as in a soup.
std::vector<bool> find_lone_triangles(const EdgeTable& edges, size_t face_count) {
    std::vector<uint8_t> open(face_count, 0);
    for (size_t e = 0; e < edges.size(); ++e) {
        if (edges.around(e).size() == 1) ++open[face_of(edges.around(e)[0])];
    }
    std::vector<bool> lone(face_count);
    for (size_t f = 0; f < face_count; ++f) lone[f] = open[f] == 3;
    return lone;
}

// Pairs boundary edges between the same two places if there are exactly two, and unites their ends.
DisjointSets stitch(const std::vector<Triangle>& triangles, const std::vector<uint32_t>& place) {
    struct OpenEdge {
        std::pair<uint32_t, uint32_t> places;
        uint32_t low_end, high_end;  // the vertices at the two places

        bool operator<(const OpenEdge& other) const { return places < other.places; }
    };
    std::vector<OpenEdge> open;
    const EdgeTable edges = build_edge_table(triangles, place.size());
    for (size_t e = 0; e < edges.size(); ++e) {
        if (edges.around(e).size() != 1) continue;
        const uint32_t h = edges.around(e)[0];
        uint32_t a = triangles[h / 3][h % 3], b = triangles[h / 3][(h % 3 + 1) % 3];
        if (place[a] == place[b]) continue;
        if (place[a] > place[b]) std::swap(a, b);
        open.push_back({{place[a], place[b]}, a, b});
    }
    std::sort(open.begin(), open.end());

    DisjointSets same(place.size());
    for (size_t k = 0; k < open.size();) {
        size_t end = k + 1;
        while (end < open.size() && open[end].places == open[k].places) ++end;
        if (end == k + 2) {
            same.unite(open[k].low_end, open[k + 1].low_end);
            same.unite(open[k].high_end, open[k + 1].high_end);
        }
        k = end;
    }
    return same;
}

struct Welded {
    std::vector<Triangle> triangles;
    CleanReport report;
};

Welded weld(const std::vector<Point>& positions, const std::vector<Triangle>& triangles, const CleanReport& report) {
    Welded result{triangles, report};
    const std::vector<uint32_t> place = number_places(positions);
    // In a soup, only positions show which triangles are degenerate or double. They would spoil the pairs of edges.
    const std::vector<bool> lone = find_lone_triangles(build_edge_table(triangles, positions.size()), triangles.size());
    remove_useless(
        result.triangles, result.report, [&](uint32_t v) { return place[v]; }, [&](uint32_t f) { return lone[f]; });

    DisjointSets same = stitch(result.triangles, place);
    std::vector<bool> used(positions.size(), false);
    for (Triangle& t : result.triangles) {
        for (uint32_t& v : t) {
            used[v] = true;
            v = same.find(v);
        }
    }
    for (uint32_t v = 0; v < used.size(); ++v) result.report.welded_vertices += used[v] && same.find(v) != v ? 1 : 0;
    remove_useless(result.triangles, result.report);
    return result;
}

// ---- orientation ----------------------------------------------------------------------------------------------------

bool run_same_way(const std::vector<Triangle>& triangles, uint32_t h, uint32_t g) {
    return triangles[h / 3][h % 3] == triangles[g / 3][g % 3];
}

// Says for each face whether it must be turned, so that each component is consistent with its first face.
// `contradiction` is the edge where a walk around the surface comes back turned over, if there is one.
struct Turning {
    std::vector<bool> turn;
    uint32_t contradiction = kNone;
};

Turning find_turning(const std::vector<Triangle>& triangles, const EdgeTable& edges) {
    std::vector<uint32_t> neighbour(3 * triangles.size(), kNone);  // per half-edge
    for (size_t e = 0; e < edges.size(); ++e) {
        const auto around = edges.around(e);
        if (around.size() != 2) continue;
        neighbour[around[0]] = around[1];
        neighbour[around[1]] = around[0];
    }
    Turning result{std::vector<bool>(triangles.size(), false)};
    std::vector<bool> seen(triangles.size(), false);
    std::vector<uint32_t> waiting;
    for (uint32_t seed = 0; seed < triangles.size(); ++seed) {
        if (seen[seed]) continue;
        seen[seed] = true;
        waiting.push_back(seed);
        while (!waiting.empty()) {
            const uint32_t f = waiting.back();
            waiting.pop_back();
            for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
                const uint32_t g = neighbour[h];
                if (g == kNone || seen[face_of(g)]) continue;
                seen[face_of(g)] = true;
                result.turn[face_of(g)] = result.turn[f] != run_same_way(triangles, h, g);
                waiting.push_back(face_of(g));
            }
        }
    }
    for (uint32_t e = 0; e < edges.size() && result.contradiction == kNone; ++e) {
        const auto around = edges.around(e);
        if (around.size() != 2) continue;
        const bool differ = result.turn[face_of(around[0])] != result.turn[face_of(around[1])];
        if (differ != run_same_way(triangles, around[0], around[1])) result.contradiction = e;
    }
    return result;
}

// Turns closed components outwards. Open components keep the side that most of their faces show.
void choose_sides(const std::vector<Point>& positions, const std::vector<Triangle>& triangles,
                  const TopologyAnalysis& topology, std::vector<bool>& turn) {
    struct Piece {
        uint64_t faces = 0, turned = 0;
        bool open = false;
        double volume = 0;  // six times the volume after turning
        Vec3 origin = Vec3::Zero();
    };
    std::vector<Piece> pieces(topology.summary.components);
    for (size_t e = 0; e < topology.edges.size(); ++e) {
        const auto around = topology.edges.around(e);
        if (around.size() == 1) pieces[topology.component_of_face[face_of(around[0])]].open = true;
    }
    const auto at = [&](uint32_t v) { return Vec3(positions[v][0], positions[v][1], positions[v][2]); };
    for (uint32_t f = 0; f < triangles.size(); ++f) {
        Piece& piece = pieces[topology.component_of_face[f]];
        const Triangle& t = triangles[f];
        if (piece.faces++ == 0) piece.origin = at(t[0]);
        piece.turned += turn[f] ? 1 : 0;
        const Vec3 a = at(t[0]) - piece.origin, b = at(t[1]) - piece.origin, c = at(t[2]) - piece.origin;
        piece.volume += (turn[f] ? -1 : 1) * a.dot(b.cross(c));
    }
    for (uint32_t f = 0; f < triangles.size(); ++f) {
        const Piece& piece = pieces[topology.component_of_face[f]];
        if (piece.open ? 2 * piece.turned > piece.faces : piece.volume < 0) turn[f] = !turn[f];
    }
}

// ---- messages -------------------------------------------------------------------------------------------------------

class Describer {
  public:
    Describer(const std::vector<Point>& positions, const std::vector<Triangle>& triangles,
              const TopologyAnalysis& topology)
        : positions_(positions), triangles_(triangles), topology_(topology) {}

    std::string edge(uint32_t e) const {
        const uint32_t h = topology_.edges.around(e)[0];
        const uint32_t a = triangles_[h / 3][h % 3], b = triangles_[h / 3][(h % 3 + 1) % 3];
        const Point &p = positions_[a], &q = positions_[b];
        return "edge " + std::to_string(a) + "-" + std::to_string(b) + " at " +
               text_of({0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2])});
    }
    std::string vertex(uint32_t v) const { return "vertex " + std::to_string(v) + " at " + text_of(positions_[v]); }

    // Describes what is not a manifold, one line each.
    std::string defects() const {
        std::string text;
        if (!topology_.nonmanifold_edges.empty()) {
            text += count_of(topology_.nonmanifold_edges.size(), "edge has", "edges have") + " more than two faces";
            for (size_t k = 0; k < std::min(kListed, topology_.nonmanifold_edges.size()); ++k) {
                const uint32_t e = topology_.nonmanifold_edges[k];
                text += "\n  " + edge(e) + " has " + std::to_string(topology_.edges.around(e).size()) + " faces";
            }
        }
        if (!topology_.nonmanifold_vertices.empty()) {
            if (!text.empty()) text += "\n";
            text += count_of(topology_.nonmanifold_vertices.size(), "vertex joins", "vertices join") +
                    " faces that are not one fan (the surface is pinched there)";
            for (size_t k = 0; k < std::min(kListed, topology_.nonmanifold_vertices.size()); ++k) {
                text += "\n  " + vertex(topology_.nonmanifold_vertices[k]);
            }
        }
        return text +
               "\nThe surface must be a 2-manifold: remove the extra faces or split the vertices in a mesh editor "
               "(\"repair non-manifold\" or \"make manifold\")";
    }

    std::string components() const {
        std::vector<uint64_t> sizes(topology_.summary.components, 0);
        for (const uint32_t c : topology_.component_of_face) ++sizes[c];
        std::sort(sizes.rbegin(), sizes.rend());
        std::string text = "the mesh has " + std::to_string(sizes.size()) + " connected components (of ";
        for (size_t k = 0; k < std::min(size_t{4}, sizes.size()); ++k)
            text += (k > 0 ? ", " : "") + std::to_string(sizes[k]);
        return text + (sizes.size() > 4 ? ", ..." : "") +
               " triangles), and this layout takes one. Use --layout mcgim (when available), or encode the pieces one "
               "by one";
    }

  private:
    const std::vector<Point>& positions_;
    const std::vector<Triangle>& triangles_;
    const TopologyAnalysis& topology_;
};

// ---- result ---------------------------------------------------------------------------------------------------------

CleanMesh compact(const std::vector<Point>& positions, const std::vector<Triangle>& triangles, CleanReport report) {
    CleanMesh result;
    std::vector<uint32_t> new_index(positions.size(), kNone);
    for (const Triangle& t : triangles) {
        for (const uint32_t v : t) new_index[v] = 0;
    }
    for (uint32_t v = 0; v < positions.size(); ++v) {
        if (new_index[v] == kNone) continue;
        new_index[v] = static_cast<uint32_t>(result.mesh.positions.size());
        result.mesh.positions.emplace_back(positions[v][0], positions[v][1], positions[v][2]);
        result.source_vertex.push_back(v);
    }
    result.mesh.triangles.reserve(triangles.size());
    for (const Triangle& t : triangles)
        result.mesh.triangles.push_back({new_index[t[0]], new_index[t[1]], new_index[t[2]]});
    report.unreferenced_vertices = positions.size() - result.mesh.positions.size() - report.welded_vertices;
    result.report = report;
    return result;
}

}  // namespace

Result<CleanMesh> clean(const TriangleMesh& input, const CleanOptions& options) {
    GIM_CHECK(check_numbers(input));
    const std::vector<Point>& positions = input.positions;

    std::vector<Triangle> triangles = input.triangles;
    CleanReport report;
    remove_useless(triangles, report);
    if (triangles.empty()) return error("every triangle of the mesh repeats a vertex; the surface has no faces");
    TopologyAnalysis topology = analyse_topology(triangles, positions.size());

    if (topology.summary.boundary_edges > 0) {
        Welded welded = weld(positions, triangles, report);
        if (!welded.triangles.empty()) {
            TopologyAnalysis after = analyse_topology(welded.triangles, positions.size());
            const auto broken = [](const TopologySummary& s) { return s.nonmanifold_edges + s.nonmanifold_vertices; };
            // A connected manifold is never welded into something worse.
            if (broken(after.summary) == 0 || broken(topology.summary) > 0 || topology.summary.components > 1) {
                triangles = std::move(welded.triangles);
                report = welded.report;
                topology = std::move(after);
            }
        }
    }

    const Describer describe(positions, triangles, topology);
    if (topology.summary.nonmanifold_edges + topology.summary.nonmanifold_vertices > 0)
        return error(describe.defects());
    Turning turning = find_turning(triangles, topology.edges);
    if (turning.contradiction != kNone) {
        return error(
            "the surface has only one side (like a Moebius strip): no orientation of its faces agrees across " +
            describe.edge(turning.contradiction) + "; cut it open or give it thickness");
    }
    if (options.require_connected && topology.summary.components > 1) return error(describe.components());

    choose_sides(positions, triangles, topology, turning.turn);
    for (size_t f = 0; f < triangles.size(); ++f) {
        if (!turning.turn[f]) continue;
        std::swap(triangles[f][1], triangles[f][2]);
        ++report.flipped_triangles;
    }
    CleanMesh result = compact(positions, triangles, report);
    result.report.topology = analyse_topology(result.mesh.triangles, result.mesh.positions.size()).summary;
    return result;
}

}  // namespace gim

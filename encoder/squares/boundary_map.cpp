#include "encoder/squares/boundary_map.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "encoder/base/result.h"
#include "format/seam.h"

namespace gim {

namespace {

// Least lengths of cut-paths on the node grid. If two paths join the same cut-nodes, one needs a second edge. A path
// that returns to its own cut-node needs three edges. Otherwise two edges would be the same.
constexpr uint32_t kLeastParallelUnits = 2, kLeastLoopUnits = 3;

// A cut-path with its mate, or an input boundary on its own.
struct PathPair {
    uint32_t path;    // the first of the two
    uint32_t copies;  // 2 with a mate, 1 without
    double length;    // on the surface
    uint32_t least;   // units
    uint32_t units = 0;
};

double path_length(const OpenedMesh& opened, size_t k) {
    const size_t first = opened.paths[k].first;
    const size_t end = k + 1 < opened.paths.size() ? opened.paths[k + 1].first : opened.loop.size();
    double length = 0;
    for (size_t i = first; i < end; ++i) {
        const Vec3& a = opened.mesh.positions[opened.loop[i]];
        const Vec3& b = opened.mesh.positions[opened.loop[(i + 1) % opened.loop.size()]];
        length += (b - a).norm();
    }
    return length;
}

std::vector<PathPair> pair_paths(const OpenedMesh& opened, uint32_t least_units) {
    std::vector<PathPair> pairs;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> between;  // how many pairs of paths join these two cut-nodes
    for (uint32_t k = 0; k < opened.paths.size(); ++k) {
        const BoundaryPath& path = opened.paths[k];
        if (path.mate < k) continue;
        const bool loop = path.begin_node == path.end_node;
        pairs.push_back({k, path.mate != kNoMate ? 2u : 1u, path_length(opened, k),
                         loop ? std::max(kLeastLoopUnits, least_units) : least_units});
        ++between[std::minmax(path.begin_node, path.end_node)];
    }
    for (PathPair& p : pairs) {
        const BoundaryPath& path = opened.paths[p.path];
        if (between[std::minmax(path.begin_node, path.end_node)] > 1) p.least = std::max(p.least, kLeastParallelUnits);
    }
    return pairs;
}

double ring_length(const std::vector<PathPair>& pairs) {
    double length = 0;
    for (const PathPair& p : pairs) length += p.copies * p.length;
    return length;
}

uint64_t least_units_of(const std::vector<PathPair>& pairs) {
    uint64_t units = 0;
    for (const PathPair& p : pairs) units += uint64_t{p.copies} * p.least;
    return units;
}

// Gives every pair its share of `total` units, but not less than its minimum; largest remainders first. Returns false
// if there are too few units.
bool allot(std::vector<PathPair>& pairs, uint32_t total) {
    const double length = ring_length(pairs);
    if (least_units_of(pairs) > total) return false;

    const auto ideal = [&](const PathPair& p) { return length > 0 ? total * p.length / length : 0.0; };
    int64_t missing = total;
    for (PathPair& p : pairs) {
        p.units = std::max(p.least, static_cast<uint32_t>(ideal(p)));
        missing -= int64_t{p.copies} * p.units;
    }
    while (missing != 0) {
        PathPair* best = nullptr;
        double best_gain = 0;
        for (PathPair& p : pairs) {
            if (missing > 0 ? int64_t{p.copies} > missing : p.units == p.least) continue;
            const double gain = missing > 0 ? ideal(p) / (p.units + 0.5) : -ideal(p) / (p.units - 0.5);
            if (best == nullptr || gain > best_gain) best = &p, best_gain = gain;
        }
        if (best == nullptr) return false;
        best->units = missing > 0 ? best->units + 1 : best->units - 1;
        missing += missing > 0 ? -int64_t{best->copies} : int64_t{best->copies};
    }
    return true;
}

// Returns the part of the ring that pairs got beyond their shares.
double excess(const std::vector<PathPair>& pairs, uint32_t total) {
    const double length = ring_length(pairs);
    if (!(length > 0)) return 0;
    double units = 0;
    for (const PathPair& p : pairs) units += p.copies * std::max(0.0, p.units - total * p.length / length);
    return units / total;
}

// Returns the offsets of valence-1 cut-nodes. There a path is followed by its own mate.
std::vector<uint32_t> leaf_offsets(const std::vector<CutPath>& paths) {
    std::vector<uint32_t> leaves;
    uint32_t at = 0;
    for (size_t k = 0; k < paths.size(); ++k) {
        at += paths[k].length;
        if (paths[k].mate == (k + 1) % paths.size()) leaves.push_back(at);
    }
    return leaves;
}

// Returns whether the node grid itself, glued this way, is a surface. If so, all finer levels are surfaces too.
bool is_closed(const Sideband& sideband) {
    SeamTable seams;
    return sideband.paths.size() <= kMaxCutPaths && build_seam_table(sideband, &seams) == Status::kOk &&
           level_is_closed(seams, sideband.node_side);
}

// Rotates the layout so that every leaf is as far from the square's corners as possible. Returns false if a leaf must
// lie on a corner, or if no rotation is closed.
bool choose_start(Sideband& sideband) {
    const uint32_t quarter = sideband.node_side - 1;
    const std::vector<uint32_t> leaves = leaf_offsets(sideband.paths);
    std::vector<std::pair<uint32_t, uint32_t>> starts;  // farthest first
    for (uint32_t start = 0; start < quarter; ++start) {
        uint32_t distance = quarter;
        for (const uint32_t leaf : leaves) {
            const uint32_t past = (start + leaf) % quarter;
            distance = std::min({distance, past, quarter - past});
        }
        if (distance > 0) starts.push_back({quarter - distance, start});
    }
    std::sort(starts.begin(), starts.end());
    for (const auto& [nearness, start] : starts) {
        sideband.start = start;
        if (is_closed(sideband)) return true;
    }
    return false;
}

Error no_room(const OpenedMesh& opened, uint32_t side) {
    const std::string text = std::to_string(side);
    return {Stage::kBoundaryMap, "the cut has " + std::to_string(opened.paths.size()) +
                                     " cut-paths, too many for the boundary of a " + text + " x " + text +
                                     " image; take a larger --size, or --layout mcgim"};
}

Result<Sideband> lay_out(const OpenedMesh& opened, const BoundaryMapOptions& options) {
    std::vector<PathPair> pairs = pair_paths(opened, std::max(options.least_units, 1u));
    for (uint32_t node_side = options.node_side; node_side <= options.side; node_side = 2 * node_side - 1) {
        const uint32_t total = 4 * (node_side - 1);
        if (!allot(pairs, total)) continue;
        if (excess(pairs, total) > options.most_excess && pairs.size() > 1 && node_side < options.side) continue;
        Sideband sideband{node_side, 0, std::vector<CutPath>(opened.paths.size())};
        for (const PathPair& p : pairs) {
            const uint32_t mate = opened.paths[p.path].mate;
            sideband.paths[p.path] = {mate, p.units};
            if (mate != kNoMate) sideband.paths[mate] = {p.path, p.units};
        }
        if (choose_start(sideband)) return sideband;
    }
    return no_room(opened, options.side);
}

// Lays the boundary out. Every vertex of the loop has an offset within its path.
class BoundaryLayout {
  public:
    BoundaryLayout(OpenedMesh& opened, const Sideband& sideband, uint32_t side)
        : opened_(opened), sideband_(sideband), samples_per_unit_((side - 1) / (sideband.node_side - 1)) {
        place_vertices();
    }

    // Puts a vertex on each corner of the square, and its mate where it belongs.
    void split_at_corners() {
        const uint32_t quarter = (sideband_.node_side - 1) * samples_per_unit_;
        for (uint32_t c = 0; c < 4; ++c) {
            const double p = c * quarter;
            for (size_t k = 0; k < runs_.size(); ++k) {
                const double total = 4.0 * quarter;
                double offset = std::fmod(p - begin_of(k) + total, total);
                if (offset <= 0 || offset >= length_of(k)) continue;
                offset = put_vertex(k, offset);
                const uint32_t mate = sideband_.paths[k].mate;
                if (mate != kNoMate) put_vertex(mate, length_of(k) - offset);
                break;
            }
        }
    }

    // Writes the loop back into the opened mesh and returns the ring positions.
    std::vector<double> finish(uint32_t side) {
        std::vector<double> ring;
        opened_.loop.clear();
        const double total = 4.0 * (side - 1);
        for (size_t k = 0; k < runs_.size(); ++k) {
            opened_.paths[k].first = static_cast<uint32_t>(opened_.loop.size());
            for (const Placed& placed : runs_[k]) {
                opened_.loop.push_back(placed.vertex);
                ring.push_back(std::fmod(begin_of(k) + placed.offset, total));
            }
        }
        return ring;
    }

  private:
    struct Placed {
        double offset;  // samples from the path's begin
        uint32_t vertex;
    };
    // A vertex closer than this to a corner (in samples) is moved onto it. Splitting would leave a tiny edge.
    static constexpr double kSnap = 1e-3;

    double length_of(size_t k) const { return double(sideband_.paths[k].length) * samples_per_unit_; }
    double begin_of(size_t k) const {
        uint64_t units = sideband_.start;
        for (size_t i = 0; i < k; ++i) units += sideband_.paths[i].length;
        return double(units * samples_per_unit_);
    }

    void place_vertices() {
        for (size_t k = 0; k < opened_.paths.size(); ++k) {
            const size_t first = opened_.paths[k].first;
            const size_t end = k + 1 < opened_.paths.size() ? opened_.paths[k + 1].first : opened_.loop.size();
            std::vector<Placed> run;
            double along = 0;
            for (size_t i = first; i < end; ++i) {
                run.push_back({along, opened_.loop[i]});
                const Vec3& a = opened_.mesh.positions[opened_.loop[i]];
                const Vec3& b = opened_.mesh.positions[opened_.loop[(i + 1) % opened_.loop.size()]];
                // Coincident neighbours still need distinct places.
                along += std::max((b - a).norm(), 1e-9 * path_scale(k));
            }
            for (Placed& placed : run) placed.offset *= length_of(k) / along;
            runs_.push_back(std::move(run));
        }
        // Mates get the same offsets, mirrored bit for bit.
        for (size_t k = 0; k < runs_.size(); ++k) {
            const uint32_t mate = opened_.paths[k].mate;
            if (mate == kNoMate || mate < k) continue;
            std::vector<Placed>& other = runs_[mate];
            for (size_t i = 1; i < other.size(); ++i)
                other[i].offset = length_of(k) - runs_[k][runs_[k].size() - i].offset;
        }
    }
    double path_scale(size_t k) const {
        const double length = path_length(opened_, k);
        return length > 0 ? length : 1;
    }

    uint32_t vertex_after(size_t k, size_t i) const {
        if (i + 1 < runs_[k].size()) return runs_[k][i + 1].vertex;
        return runs_[(k + 1) % runs_.size()].front().vertex;
    }

    // Makes sure that a vertex lies at `offset` of path k. Returns the offset at which it lies.
    double put_vertex(size_t k, double offset) {
        std::vector<Placed>& run = runs_[k];
        const auto after =
            std::upper_bound(run.begin(), run.end(), offset, [](double o, const Placed& p) { return o < p.offset; });
        const auto i = static_cast<size_t>(after - run.begin()) - 1;
        const double here = run[i].offset, there = i + 1 < run.size() ? run[i + 1].offset : length_of(k);
        if (i > 0 && offset - here < kSnap * std::min(1.0, there - run[i - 1].offset)) {
            run[i].offset = offset;
            return offset;
        }
        if (i + 1 < run.size() && there - offset < kSnap * std::min(1.0, there - here)) {
            run[i + 1].offset = offset;
            return offset;
        }
        const double t = (offset - here) / (there - here);
        const uint32_t inserted = split_boundary_edge(run[i].vertex, vertex_after(k, i), t);
        run.insert(run.begin() + static_cast<std::ptrdiff_t>(i) + 1, {offset, inserted});
        return offset;
    }

    uint32_t split_boundary_edge(uint32_t a, uint32_t b, double t) {
        Mesh& mesh = opened_.mesh;
        const auto inserted = static_cast<uint32_t>(mesh.positions.size());
        mesh.positions.push_back(mesh.positions[a] + t * (mesh.positions[b] - mesh.positions[a]));
        opened_.source.push_back(kNone);
        for (size_t f = 0; f < mesh.triangles.size(); ++f) {
            for (size_t i = 0; i < 3; ++i) {
                if (mesh.triangles[f][i] != a || mesh.triangles[f][(i + 1) % 3] != b) continue;
                Triangle half = mesh.triangles[f];
                half[i] = inserted;
                mesh.triangles[f][(i + 1) % 3] = inserted;
                mesh.triangles.push_back(half);
                return inserted;
            }
        }
        return inserted;
    }

    OpenedMesh& opened_;
    const Sideband& sideband_;
    uint32_t samples_per_unit_;
    std::vector<std::vector<Placed>> runs_;  // per path: its vertices without the last, which begins the next path
};

uint8_t sides_of(double p, uint32_t side) {
    const double quarter = side - 1;
    uint8_t bits = 0;
    for (int s = 0; s < 4; ++s) {
        if (p >= s * quarter && p <= (s + 1) * quarter) bits |= static_cast<uint8_t>(1 << s);
    }
    if (p == 0) bits |= 8;
    return bits;
}

// Splits interior edges that join two vertices of one side of the square, at their middle. A face may have several such
// edges. Each round therefore splits edges of disjoint faces, until none is left.
void split_chords(SquareBoundary& boundary) {
    Mesh& mesh = boundary.opened.mesh;
    std::vector<uint8_t>& sides = boundary.sides;
    for (bool again = true; again;) {
        again = false;
        const Topology topology = build_topology(mesh);
        std::vector<uint8_t> touched(mesh.triangles.size(), 0);
        const auto half_edges = static_cast<uint32_t>(topology.twin.size());
        for (uint32_t h = 0; h < half_edges; ++h) {
            const uint32_t t = topology.twin[h];
            const uint32_t a = from(mesh, h), b = to(mesh, h);
            if (t == kNone || t < h || touched[face_of(h)] || touched[face_of(t)] || (sides[a] & sides[b]) == 0)
                continue;
            again = true;
            touched[face_of(h)] = touched[face_of(t)] = 1;
            const auto middle = static_cast<uint32_t>(mesh.positions.size());
            mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
            boundary.opened.source.push_back(kNone);
            sides.push_back(0);
            for (const uint32_t e : {h, t}) {
                Triangle& face = mesh.triangles[face_of(e)];
                Triangle half = face;
                half[e % 3] = middle;
                face[next(e) % 3] = middle;
                mesh.triangles.push_back(half);
            }
        }
    }
}

}  // namespace

Vec2 ring_point(double p, uint32_t side) {
    const double quarter = side - 1;
    const double t = p / quarter;
    if (t <= 1) return {t, 0};
    if (t <= 2) return {1, t - 1};
    if (t <= 3) return {3 - t, 1};
    return {0, 4 - t};
}

std::vector<Vec2> boundary_uv(const SquareBoundary& boundary, uint32_t side) {
    std::vector<Vec2> uv(boundary.opened.mesh.positions.size(), Vec2(0.5, 0.5));
    for (size_t i = 0; i < boundary.ring.size(); ++i) uv[boundary.opened.loop[i]] = ring_point(boundary.ring[i], side);
    return uv;
}

Result<void> check_room(const OpenedMesh& opened, const BoundaryMapOptions& options) {
    const std::vector<PathPair> pairs = pair_paths(opened, std::max(options.least_units, 1u));
    if (least_units_of(pairs) > 4 * uint64_t{options.side - 1}) return no_room(opened, options.side);
    return {};
}

Result<SquareBoundary> map_boundary(OpenedMesh opened, const BoundaryMapOptions& options) {
    GIM_TRY(sideband, lay_out(opened, options));
    SquareBoundary boundary{std::move(opened), std::move(sideband), {}, {}};
    BoundaryLayout layout(boundary.opened, boundary.sideband, options.side);
    layout.split_at_corners();
    boundary.ring = layout.finish(options.side);
    boundary.sides.assign(boundary.opened.mesh.positions.size(), 0);
    for (size_t i = 0; i < boundary.ring.size(); ++i)
        boundary.sides[boundary.opened.loop[i]] = sides_of(boundary.ring[i], options.side);
    split_chords(boundary);
    return boundary;
}

}  // namespace gim

#include "encoder/tiles/part_base.h"

#include <algorithm>

#include "encoder/base/disjoint_sets.h"
#include "encoder/tiles/base_mesh.h"
#include "encoder/tiles/even_patches.h"
#include "encoder/tiles/perfect_matching.h"
#include "encoder/tiles/tile_map.h"

namespace gim {

namespace {

// Tries in all, and tries until the base may be larger. A large base is tried less often, because that takes longer.
constexpr uint32_t kMostTries = 120, kFacesTried = 24000, kTriesPerSize = 12;
// Rounds of pairing that tell whether a base has faults.
constexpr uint32_t kQuickRounds = 15;
// A triangle without a partner, and a vertex without a place in the tiles, against a vertex of two quads.
constexpr size_t kUnpairedFaults = 1000, kLeftOutFaults = 10;

struct Try {
    PartBase base;
    BaseMesh mesh;
    QuadPairing pairing;
    std::vector<uint32_t> left_out;  // vertices of the part that the map to the tiles has no place for
    size_t faults = SIZE_MAX;
    double damage = 0;

    bool better_than(const Try& o) const { return faults != o.faults ? faults < o.faults : damage < o.damage; }
};

// Vertices that a quick map leaves out. They are those that go late: between base vertices faces have right angles in the
// tiles, however narrow they are on the surface.
std::vector<uint32_t> without_place(const Mesh& part, const BaseMesh& base, const QuadPairing& pairing) {
    TileMapOptions quick;
    quick.growth = 2;
    quick.sweeps = quick.final_sweeps = 1;
    auto map = map_tiles(part, base, pairing.quads, quick);
    if (map.ok()) return std::move(map.value().left_out);
    return std::vector<uint32_t>(1, base.triangles[0][0]);
}

class PartTries {
  public:
    explicit PartTries(const PartMesh& part)
        : part_(part), seeds_(part.mesh.positions.size(), 0), smooth_(part.mesh.positions.size(), true) {
        const Topology topology = build_topology(part.mesh);
        for (uint32_t h = 0; h < topology.twin.size(); ++h) {
            if (topology.twin[h] == kNone || part.sharp[h])
                smooth_[from(part.mesh, h)] = smooth_[to(part.mesh, h)] = false;
        }
    }

    Try first(uint32_t count);
    // Varies the base around the faults of the one before.
    Try vary(const Try& before, uint32_t faces, uint32_t seed);

  private:
    Try judge(Decimator& decimator) const;
    std::vector<bool> near_faults(const Try& before) const;

    const PartMesh& part_;
    std::vector<uint32_t> seeds_;  // per vertex of the part
    std::vector<bool> smooth_;     // per vertex: no crease or boundary ends there
};

Try PartTries::judge(Decimator& decimator) const {
    make_patches_even(decimator);
    Try result{{decimator.collapses(), decimator.removed_by()},
               base_after(part_.mesh, part_.sharp, decimator.collapses(), decimator.removed_by()),
               {},
               {}};
    result.pairing = pair_triangles(part_.mesh.positions, result.mesh, kQuickRounds);
    const QuadPairing& p = result.pairing;
    if (p.unpaired.empty()) result.left_out = without_place(part_.mesh, result.mesh, p);
    result.faults = kUnpairedFaults * p.unpaired.size() + kLeftOutFaults * result.left_out.size() + p.crossed.size() +
                    p.doublets.size() + p.twins;
    result.damage = decimator.damage();
    return result;
}

Try PartTries::first(uint32_t count) {
    Decimator decimator(part_.mesh, part_.sharp, part_.shares);
    for (uint32_t i = 0; i < count; ++i) decimator.collapse(part_.collapses[i].vertex, part_.collapses[i].into);
    return judge(decimator);
}

// Per triangle its patch, and whether that cannot be paired by itself.
std::vector<bool> unpairable_triangles(const std::vector<Vec3>& positions, const BaseMesh& base) {
    const std::vector<Triangle>& triangles = base.triangles;
    const Topology topology = build_topology({positions, triangles});
    DisjointSets patches(triangles.size());
    std::vector<WeightedEdge> inner;
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        const uint32_t t = topology.twin[h], a = triangles[h / 3][h % 3], b = triangles[h / 3][(h % 3 + 1) % 3];
        const std::array<uint32_t, 2> edge{std::min(a, b), std::max(a, b)};
        if (t == kNone || t < h || std::binary_search(base.creases.begin(), base.creases.end(), edge)) continue;
        patches.unite(h / 3, t / 3);
        inner.push_back({h / 3, t / 3, 0});
    }
    std::vector<std::vector<WeightedEdge>> edges(triangles.size());
    std::vector<uint32_t> place(triangles.size()), sizes(triangles.size(), 0);
    for (uint32_t f = 0; f < triangles.size(); ++f) place[f] = sizes[patches.find(f)]++;
    for (const WeightedEdge& e : inner) edges[patches.find(e.a)].push_back({place[e.a], place[e.b], 0});
    std::vector<bool> unpairable(triangles.size(), false);
    for (uint32_t f = 0; f < triangles.size(); ++f) {
        const uint32_t patch = patches.find(f);
        unpairable[f] = patch < f ? unpairable[patch] : perfect_matching(sizes[f], edges[f]).empty();
    }
    return unpairable;
}

// The vertices of patches that cannot be paired, those around doublets, and those where the map has no place.
std::vector<bool> PartTries::near_faults(const Try& before) const {
    std::vector<bool> near(part_.mesh.positions.size(), false), doublet(near.size(), false);
    const std::vector<bool> unpairable = unpairable_triangles(part_.mesh.positions, before.mesh);
    for (const uint32_t v : before.pairing.doublets) doublet[v] = true;
    for (uint32_t f = 0; f < unpairable.size(); ++f) {
        const Triangle& t = before.mesh.triangles[f];
        if (!unpairable[f] && !doublet[t[0]] && !doublet[t[1]] && !doublet[t[2]]) continue;
        for (const uint32_t v : t) near[v] = true;
    }
    std::vector<bool> left_out(near.size(), false);
    for (const uint32_t v : before.left_out) left_out[v] = true;
    for (size_t i = before.base.collapses.size(); i-- > 0;) {
        const HalfEdgeCollapse& c = before.base.collapses[i];
        if (left_out[c.vertex]) near[c.into] = true;
        if (near[c.into]) near[c.vertex] = true;  // vertices that moved there vary too
    }
    return near;
}

Try PartTries::vary(const Try& before, uint32_t faces, uint32_t seed) {
    const std::vector<bool> near = near_faults(before);
    const std::vector<uint32_t> old = seeds_;
    for (size_t v = 0; v < near.size(); ++v) {
        // If only smooth vertices vary, patches stay even.
        if (near[v] && (seed % 2 == 0 || smooth_[v])) seeds_[v] = seed;
    }
    Decimator decimator(part_.mesh, part_.sharp, part_.shares, seeds_);
    decimator.run(faces);
    Try result = judge(decimator);
    if (!result.better_than(before)) seeds_ = old;
    return result;
}

}  // namespace

PartBase choose_part_base(const PartMesh& part, uint32_t count) {
    PartTries tries(part);
    Try best = tries.first(count);
    const auto faces = static_cast<uint32_t>(part.mesh.triangles.size());
    uint32_t wanted = faces;
    for (uint32_t i = 0; i < count; ++i)
        wanted -= (part.collapses[i].left != kNone) + (part.collapses[i].right != kNone);
    const uint32_t most = std::clamp(kFacesTried / faces, 4u, kMostTries);
    for (uint32_t i = 1; i <= most && best.faults > 0; ++i) {
        // A boundary with too many corners leaves triangles alone, and a coarser one has fewer.
        if (!best.pairing.unpaired.empty()) wanted -= std::min(wanted, wanted / 8 + 1);
        Try now = tries.vary(best, wanted + 2 * (i / kTriesPerSize), i);
        if (now.better_than(best)) best = std::move(now);
    }
    return std::move(best.base);
}

}  // namespace gim

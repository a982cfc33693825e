#include "encoder/tiles/part_base.h"

#include <algorithm>
#include <cmath>

#include "encoder/tiles/base_mesh.h"
#include "encoder/tiles/even_patches.h"

namespace gim {

namespace {

// Tries with finer cuts. A large base is paired less often, because that takes longer.
constexpr uint32_t kMostTries = 24, kFacesTried = 12000;
// Repairs look at the cheapest collapses around a doublet, and at as many after each of them.
constexpr size_t kBranches = 4;
constexpr int kDeepest = 2;
// Rounds of pairing that tell whether a repair helps.
constexpr uint32_t kQuickRounds = 10;

struct Try {
    std::vector<HalfEdgeCollapse> collapses;
    std::vector<uint32_t> removed_by;
    std::vector<uint32_t> doublets;
    size_t faults = SIZE_MAX;
    double cost = HUGE_VAL;  // of the repairs
};

class PartTries {
  public:
    explicit PartTries(const PartMesh& part) : part_(part) {}

    // The first collapses of the list, and those that make the patches even.
    Try cut(uint32_t count) const {
        Decimator decimator(part_.mesh, part_.sharp, part_.shares);
        for (uint32_t i = 0; i < count; ++i) decimator.collapse(part_.collapses[i].vertex, part_.collapses[i].into);
        make_patches_even(decimator);
        return judge(decimator, 0, 2 * kQuickRounds);
    }

    // Collapses vertices around doublets as long as that leaves fewer faults.
    Try repair(Try now) const {
        while (now.faults > 0) {
            Try best = now;
            for (const uint32_t doublet : now.doublets) {
                Try repaired = now;
                search(now, neighbourhood(now, doublet), 1, repaired);
                if (repaired.faults < now.faults && better(repaired, best)) best = std::move(repaired);
            }
            if (best.faults >= now.faults) break;
            now = std::move(best);
        }
        return now;
    }

  private:
    static bool better(const Try& a, const Try& b) { return a.faults != b.faults ? a.faults < b.faults : a.cost < b.cost; }

    Try judge(const Decimator& decimator, double cost, uint32_t rounds) const;
    std::vector<uint32_t> neighbourhood(const Try& now, uint32_t vertex) const;
    void search(const Try& now, const std::vector<uint32_t>& vertices, int depth, Try& best) const;

    const PartMesh& part_;
};

void replay(Decimator& decimator, const std::vector<HalfEdgeCollapse>& collapses) {
    for (const HalfEdgeCollapse& c : collapses) decimator.collapse(c.vertex, c.into);
}

Try PartTries::judge(const Decimator& decimator, double cost, uint32_t rounds) const {
    const BaseMesh base = base_after(part_.mesh, part_.sharp, decimator.collapses(), decimator.removed_by());
    const QuadPairing pairing = pair_triangles(part_.mesh.positions, base, rounds);
    const size_t faults =
        1000 * pairing.unpaired.size() + pairing.crossed.size() + pairing.doublets.size() + pairing.twins;
    return {decimator.collapses(), decimator.removed_by(), pairing.doublets, faults, cost};
}

std::vector<uint32_t> PartTries::neighbourhood(const Try& now, uint32_t vertex) const {
    Decimator decimator(part_.mesh, part_.sharp, part_.shares);
    replay(decimator, now.collapses);
    std::vector<uint32_t> vertices{vertex};
    const CollapseMesh& mesh = decimator.mesh();
    for (auto w = mesh.cvv_begin(mesh.vertex_handle(vertex)); w.is_valid(); ++w) vertices.push_back(index(*w));
    return vertices;
}

void PartTries::search(const Try& now, const std::vector<uint32_t>& vertices, int depth, Try& best) const {
    struct Option {
        double cost;
        uint32_t vertex, into;
        bool operator<(const Option& o) const { return cost != o.cost ? cost < o.cost : vertex < o.vertex; }
    };
    std::vector<Option> options;
    {
        Decimator decimator(part_.mesh, part_.sharp, part_.shares);
        replay(decimator, now.collapses);
        const CollapseMesh& mesh = decimator.mesh();
        for (const uint32_t v : vertices) {
            if (mesh.status(mesh.vertex_handle(v)).deleted()) continue;
            const CollapseCost::Candidate candidate = decimator.best(v);
            if (candidate.edge.is_valid())
                options.push_back({candidate.cost, v, index(mesh.to_vertex_handle(candidate.edge))});
        }
    }
    std::sort(options.begin(), options.end());
    if (options.size() > kBranches) options.resize(kBranches);
    std::vector<Try> tries;
    for (const Option& option : options) {
        Decimator decimator(part_.mesh, part_.sharp, part_.shares);
        replay(decimator, now.collapses);
        decimator.collapse(option.vertex, option.into);
        make_patches_even(decimator);
        tries.push_back(judge(decimator, now.cost + option.cost, kQuickRounds));
        if (better(tries.back(), best)) best = tries.back();
    }
    if (depth == kDeepest) return;
    for (const Try& deeper : tries) search(deeper, vertices, depth + 1, best);
}

}  // namespace

PartBase choose_part_base(const PartMesh& part, uint32_t count) {
    const PartTries tries(part);
    const auto faces = static_cast<uint32_t>(part.mesh.triangles.size());
    const uint32_t most = std::clamp(kFacesTried / faces, 2u, kMostTries);
    Try best;
    for (uint32_t i = 0; i < most && i <= count && best.faults > 0; ++i) {
        Try now = tries.cut(count - i);
        if (now.faults < best.faults) best = std::move(now);
    }
    best.cost = 0;
    best = tries.repair(std::move(best));
    return {std::move(best.collapses), std::move(best.removed_by)};
}

}  // namespace gim

#include <cstdio>
#include <cstdlib>
#include "encoder/tiles/part_base.h"

#include <algorithm>

#include "encoder/tiles/base_mesh.h"
#include "encoder/tiles/even_patches.h"

namespace gim {

namespace {

constexpr int kMostRepairs = 12;
// Tries with finer cuts. A large base is paired less often, because that takes longer.
constexpr uint32_t kMostTries = 24, kFacesTried = 12000;

struct Try {
    PartBase base;
    size_t faults;
};

// Removes vertices where only two quads meet. Returns whether any could go.
bool remove_doublets(Decimator& decimator, const QuadPairing& pairing) {
    bool any = false;
    for (const uint32_t v : pairing.doublets) any |= decimator.remove(v);
    return any;
}

size_t fault_count(const QuadPairing& pairing) {
    return 1000 * pairing.unpaired.size() + pairing.crossed.size() + pairing.doublets.size() + pairing.twins;
}

Try try_cut(const PartMesh& part, uint32_t count) {
    Decimator decimator(part.mesh, part.sharp, part.shares);
    for (uint32_t i = 0; i < count; ++i) decimator.collapse(part.collapses[i].vertex, part.collapses[i].into);
    Try best{{}, SIZE_MAX};
    for (int repair = 0; repair < kMostRepairs; ++repair) {
        make_patches_even(decimator);
        const BaseMesh base = base_after(part.mesh, part.sharp, decimator.collapses(), decimator.removed_by());
        const QuadPairing pairing = pair_triangles(part.mesh.positions, base);
        const size_t faults = fault_count(pairing);
        if (faults < best.faults) best = {{decimator.collapses(), decimator.removed_by()}, faults};
        if (getenv("TRY")) fprintf(stderr, "  cut %u faces %u: unpaired %zu crossed %zu doublets %zu\n", count, decimator.face_count(), pairing.unpaired.size(), pairing.crossed.size(), pairing.doublets.size());
        if (faults == 0 || getenv("NOREP") || !remove_doublets(decimator, pairing)) break;
    }
    return best;
}

}  // namespace

PartBase choose_part_base(const PartMesh& part, uint32_t count) {
    Try best{{}, SIZE_MAX};
    const auto faces = static_cast<uint32_t>(part.mesh.triangles.size());
    const uint32_t tries = std::clamp(kFacesTried / faces, 2u, kMostTries);
    for (uint32_t i = 0; i < tries && i <= count && best.faults > 0; ++i) {
        Try now = try_cut(part, count - i);
        if (now.faults < best.faults) best = std::move(now);
    }
    return std::move(best.base);
}

}  // namespace gim

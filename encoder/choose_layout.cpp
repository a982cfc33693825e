#include "encoder/choose_layout.h"

#include "encoder/layouts.h"

namespace gim {

Layout choose_layout(const Mesh& mesh, const EncodeOptions& options, StageClock& clock) {
    const bool is_lossless = options.rate.kind == RateTarget::Kind::kLossless;
    const LayoutEntry* best = nullptr;
    double most = 0;
    for (const LayoutEntry& entry : rated_layouts()) {
        const bool is_last = &entry == &rated_layouts().back();
        if (!is_lossless && is_last) return entry.layout;  // nothing else can take the mesh
        const double efficiency = entry.efficiency(mesh, options, clock);
        if (!is_lossless && efficiency > 0) return entry.layout;
        if (best != nullptr && efficiency <= most) continue;
        best = &entry;
        most = efficiency;
    }
    return best->layout;
}

}  // namespace gim

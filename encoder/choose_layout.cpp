#include "encoder/choose_layout.h"

#include "encoder/layouts.h"

namespace gim {

Layout choose_layout(const Mesh& mesh, const EncodeOptions& options, StageClock& clock) {
    Layout best = all_layouts().front().layout;
    double most = 0;
    for (const LayoutEntry& entry : all_layouts()) {
        const double samples = entry.effective_samples(mesh, options, clock);
        if (samples <= most) continue;
        best = entry.layout;
        most = samples;
    }
    return best;
}

}  // namespace gim

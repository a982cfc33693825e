// --layout auto for lossless files: chooses the layout that should give the best PSNR.
#pragma once

#include "encoder/base/stage_clock.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// All layouts take about the same bytes per sample, so the one with most effective samples wins. Effective samples are
// samples times stretch efficiency (Sander et al. 2003, section 5: what charts gain over one square). All parametrizations
// are made for this; none is fitted.
// Cost: seconds. `mesh` must be clean.
Layout choose_layout(const Mesh& mesh, const EncodeOptions& options, StageClock& clock);

}  // namespace gim

// --layout auto: chooses the layout that should give the better PSNR for the same budget, squares or charts.
#pragma once

#include "encoder/base/stage_clock.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Lossless: both layouts take about the same bytes per sample, so the one with more effective samples wins. Effective
// samples are samples times stretch efficiency (Sander et al. 2003, section 5: what charts gain over one square). Both
// parametrizations are made for this; neither is fitted.
// Lossy: squares win unless the surface cannot be cut open onto one. Each chart adds about 150 bytes: its border is
// stored, and the wavelet cannot predict across it. Charts do not earn this back at useful rates: a horse at 70 dB
// takes 3 times the bytes.
// Cost: seconds. `mesh` must be clean.
Layout choose_layout(const Mesh& mesh, const EncodeOptions& options, StageClock& clock);

}  // namespace gim

// --layout auto: one square or charts, whichever should give the better PSNR for the same budget.
#pragma once

#include "encoder/base/stage_clock.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Lossless images cost about the same bytes a sample in both layouts, so that the one with more effective samples wins: those
// of an image times its stretch efficiency (Sander et al. 2003, section 5: what charts gain over one square). Both
// parametrizations are made for that, neither is fitted. Coded with loss, every chart costs some 150 bytes more
// than the same surface on a square, for borders and for what is smooth across seams, which charts never earn back at useful
// rates: measured, a horse at 70 dB takes 3 times the bytes. So the square wins unless the surface cannot be cut open onto one.
// Cost: seconds. `mesh`: clean.
Layout choose_layout(const Mesh& mesh, const EncodeOptions& options, StageClock& clock);

}  // namespace gim

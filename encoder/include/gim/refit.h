// Images of other programs whose samples are fitted to the mesh that they show, before they are coded. The image is only the
// start and the parametrization. The mesh is the reference of targets and figures. It is cleaned as encode() does. All
// functions fail if image and mesh lie apart. EncodeOptions::fit counts; kOff: no sample moves, only the reference changes.
#pragma once

#include <cstdint>
#include <vector>

#include "gim/encoder.h"

namespace gim {

// As encode_image(). Samples on open sides of the image go to the mesh's boundary; they stay if it has none.
Result<Encoded> refit_image(const std::vector<float>& channels, uint32_t side, double weld_tolerance,
                            const TriangleMesh& mesh, const EncodeOptions& options, const Progress& progress = {});

// As encode_raster(), from the fitted samples on: with RateTarget::kLossless the file keeps these exactly. Whole numbers
// stay whole. FitStrength::kAuto is kStiff if there are channels besides the positions, because they belong to the places
// of their samples. Samples on open borders go to the mesh's boundary if that is nearer than the next sample; else they
// stay, at the nearest point of the mesh.
Result<Encoded> refit_raster(const RasterImage& image, const TriangleMesh& mesh, const EncodeOptions& options,
                             const Progress& progress = {});

}  // namespace gim

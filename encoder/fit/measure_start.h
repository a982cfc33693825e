// Measures an image of another program before it is fitted to a mesh.
#pragma once

#include "encoder/base/result.h"
#include "encoder/fit/fit.h"

namespace gim {

// An Error if image and mesh lie so far apart that the image is no parametrization of the mesh.
Result<FitQuality> measure_start(const GeometryImage& image, const Mesh& mesh, uint32_t threads);

}  // namespace gim

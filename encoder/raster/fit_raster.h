// Fits the samples of an imported image to a mesh (fit/fit.h): the image is only the start and the parametrization.
#pragma once

#include <vector>

#include "encoder/base/result.h"
#include "encoder/fit/fit.h"
#include "encoder/raster/glue_raster.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// In:  an image with its gluing, its positions (one per sample, object space) and the mesh it shows, clean and oriented.
// Out: the image with other positions, equal where glued. Whole numbers stay whole and in the range of their type. Samples
//      on the border of the image's surface go to the mesh's boundary if that is nearer than the next sample. Others go
//      to the nearest point of the mesh and stay there, so that borders which coincide do not part.
// An Error if image and mesh lie apart.
// Cost: that of the fit.
struct FittedRaster {
    RasterImage image;
    FitQuality before, after;
};
Result<FittedRaster> fit_raster(const RasterImage& image, const RasterGluing& gluing,
                                const std::vector<Vec3>& positions, const Mesh& mesh, const FitOptions& options,
                                const Progress& progress = {});

}  // namespace gim

// Writes an imported image as a .gim file.  spec/gim-format.md, "Rasters".
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/raster/glue_raster.h"
#include "encoder/raster/quantize_raster.h"

namespace gim {

// quantizer: units per number of a position; 0: lossless.
std::vector<uint8_t> write_raster(const RasterImage& image, const RasterScale& scale, const RasterGluing& gluing,
                                  double quantizer);

}  // namespace gim

// Turns the numbers of an imported image into those that a file stores.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/surface/mesh.h"
#include "format/container.h"
#include "format/raster_table.h"
#include "gim/encoder.h"

namespace gim {

// The scales of all channels.
struct RasterScale {
    Units units;                                       // of the positions
    std::optional<std::array<double, 3>> wide_origin;  // as in Header
    std::array<double, 3> low{};                       // where positions of 0 units lie, in object space
    bool is_exact = false;                             // the positions are whole numbers, and a unit is 1
    std::vector<RasterChannel> others;                 // channels from the fourth on
};

// Checks the image. The Error names the sample or the channel.
Result<RasterScale> scale_raster(const RasterImage& image, uint32_t bits);

// Positions of all samples, 0 where undefined.
std::vector<Vec3> raster_positions(const RasterImage& image);

// The numbers of all channels, sample by sample. quantizer: units per number of a position, at least 1.
std::vector<int32_t> quantized(const RasterImage& image, const RasterScale& scale, double quantizer);

}  // namespace gim

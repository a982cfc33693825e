// Finds the border samples of an imported image that are one point of the surface.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

struct RasterGluing {
    std::vector<uint8_t> depth;       // per sample: kOnBorder, kInside, kUndefined (format/chart_ramp.h)
    std::vector<uint32_t> origin;     // per sample: the first sample of its point
    std::vector<uint32_t> point;      // per sample: its point, numbered by first appearance
    std::vector<uint8_t> is_shared;   // per sample: 1 if its point has others
    uint32_t points = 0, pieces = 0;  // pieces: of the mask, connected by sides: no cell joins two at a corner
    uint64_t defined = 0, border = 0, open = 0;  // open: border samples that are alone
};

// Border samples within the tolerance of each other become one point: each joins the nearest point before it. Samples that
// lie side by side in the image only do so at equal positions. positions: one per sample.
RasterGluing glue_raster(const RasterImage& image, const std::vector<Vec3>& positions, double tolerance);

// Sets all that follows from the origins.
void number_points(RasterGluing& gluing);

}  // namespace gim

// Closes borders of an imported image that run along one curve with samples at other places, as those of charts of different
// density do.
//
// After: Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.5 (zippering). Their borders
// are known to match. Ours are found by distance, and no sample changes its numbers: only points of the surface become one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/raster/glue_raster.h"
#include "encoder/surface/mesh.h"

namespace gim {

// In:  an image whose equal points are glued; positions, one per sample; units as for raster_triangles().
// Out: open border samples within the tolerance of another border have the point of one of its samples, the nearest one or
//      one beside it. Borders whose samples are nearer to each other than twice the tolerance stay open.
// Cost: O(samples).
void zip_borders(uint32_t width, uint32_t height, std::span<const float> units, const std::vector<Vec3>& positions,
                 double tolerance, RasterGluing& gluing);

}  // namespace gim

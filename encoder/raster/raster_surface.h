// The triangles of an imported image, as the decoder makes them.  spec/gim-format.md, "Charts", "Surface".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/image/gluing.h"
#include "encoder/raster/glue_raster.h"
#include "encoder/surface/mesh.h"

namespace gim {

// Which triangles each cell has, row by row.
std::vector<CellKind> raster_cells(const RasterGluing& gluing, uint32_t width, uint32_t height);

// units: three binary32 numbers per sample, of which the shorter diagonals follow. Triangles index samples.
std::vector<Triangle> raster_triangles(const RasterGluing& gluing, uint32_t width, uint32_t height,
                                       std::span<const float> units);

// Parts samples again where an edge of the glued surface would have more than two triangles. It looks a few times.
void open_crowded_edges(uint32_t width, uint32_t height, std::span<const float> units, RasterGluing& gluing);

// The surface through the first sample of each point. positions: one per sample.
Mesh raster_surface(const RasterGluing& gluing, std::span<const Triangle> triangles,
                    const std::vector<Vec3>& positions);

}  // namespace gim

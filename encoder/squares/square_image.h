// Turns a square of samples into a geometry image. The sideband says which samples of its ring are one surface point.
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3.3 (the sideband).
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/image/geometry_image.h"
#include "format/sideband.h"

namespace gim {

// Samples of a square that is not glued yet.
struct SquareGrid {
    uint32_t side = 0;
    std::vector<Vec3> positions;  // side * side, row-major

    const Vec3& at(uint32_t row, uint32_t column) const { return positions[size_t{row} * side + column]; }
    Vec3& at(uint32_t row, uint32_t column) { return positions[size_t{row} * side + column]; }
};

// A geometry image on a square of side 2^j + 1, and the sideband that defines its gluing.
struct SquareImage : GeometryImage {
    Sideband sideband;  // empty paths: an open square

    uint32_t side() const { return width(); }
    const Vec3& at(uint32_t row, uint32_t column) const { return positions[size_t{row} * side() + column]; }
    Vec3& at(uint32_t row, uint32_t column) { return positions[size_t{row} * side() + column]; }
};

// Both fail if the sideband does not describe the ring of an image of that side. O(side^2).
Result<GridGluing> glue_ring(const Sideband& sideband, uint32_t side);
Result<SquareImage> glue_square(SquareGrid grid, Sideband sideband);

}  // namespace gim

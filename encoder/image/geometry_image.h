// The model that every stage works from or to: surface points on a square grid and how its boundary is glued.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"
#include "format/sideband.h"

namespace gim {

struct GeometryImage {
    uint32_t side = 0;            // samples per side, 2^j + 1
    std::vector<Vec3> positions;  // side * side, row-major: sample (row, column) at row * side + column
    Sideband sideband;            // gluing of the ring (format/sideband.h); empty paths: an open square

    const Vec3& at(uint32_t row, uint32_t column) const { return positions[size_t{row} * side + column]; }
    Vec3& at(uint32_t row, uint32_t column) { return positions[size_t{row} * side + column]; }
};

}  // namespace gim

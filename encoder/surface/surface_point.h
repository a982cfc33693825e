// A place on a mesh: a triangle and the barycentric coordinates in it.
#pragma once

#include <array>
#include <cstdint>

#include "encoder/surface/mesh.h"

namespace gim {

struct SurfacePoint {
    uint32_t triangle = kNone;
    std::array<double, 3> barycentric{};
};

}  // namespace gim

// Rails: curves of the surface that samples of an image lie on and must not leave, as its creases.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

struct Rails {
    std::vector<std::vector<Vec3>> curves;  // polylines; one of a single point holds its samples still
    std::vector<uint32_t> of_sample;        // per sample of the image: its curve, or kNone; empty: none has one
};

}  // namespace gim

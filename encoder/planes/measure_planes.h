// Decodes the planes of a complete file and compares them with the input.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/planes/input_colors.h"
#include "encoder/planes/sample_planes.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// The attributes that the planes should show.
struct PlaneReference {
    const Mesh& surface;
    const AttributeSource& normals;
    const InputColors* colors = nullptr;  // needed for colours only
    uint64_t seed = 1;
    uint32_t threads = 0;
};

// The file must have a plane of each kind. O(samples log F).
Result<std::vector<PlaneReport>> measure_planes(std::span<const uint8_t> file, std::span<const PlaneReport::Kind> kinds,
                                                const PlaneReference& reference);

}  // namespace gim

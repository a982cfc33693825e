// From a camera to what the shaders want.
#pragma once

#include <array>
#include <cstdint>

#include "tools/gpu/shader_types.h"

namespace gim {

struct Camera {
    std::array<double, 3> eye{0, 0, 3}, target{}, up{0, 1, 0};
    double field_of_view = 0.8;  // from the lower to the upper edge of the frame, radians
    double nearest = 0.1, farthest = 100;
    uint32_t width = 256, height = 256;  // of the frame
};

// pixel_error: how many pixels an error may have (ShaderInstance.error). Depth is 0 at `nearest` and 1 at `farthest`; the
// y axis of the frame points up. Light and colours stay as they are by default.
ShaderView view_of(const Camera& camera, double pixel_error = 1);

}  // namespace gim

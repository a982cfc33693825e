// The triangles that the tessellator makes, taken from the GPU before they are drawn.
#pragma once

#include <vector>

#include "tests/gpu/software_frame.h"
#include "tools/gpu/gl_surface.h"

namespace gim::test {

// Of one instance that is not transformed. The surface's view is changed.
std::vector<SoftTriangle> captured_triangles(GlSurface& surface, const SurfaceData& data);

}  // namespace gim::test

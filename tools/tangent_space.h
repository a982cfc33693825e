// Writes normals in the frame of the decoded surface, as real-time renderers take them (glTF 2.0, 3.7.2.1 and 3.9.3).
#pragma once

#include <cstdint>
#include <vector>

#include "tools/decoded.h"

namespace gim {

// Returns 4 numbers per grid sample: the unit direction of rising column, perpendicular to the sample's normal, and -1.
// The third direction, cross(normal, tangent) * -1, is that of falling row (textures are stored top row first).
std::vector<float> grid_tangents(const DecodedImage& image);

// Returns the plane's object-space normals as 8-bit rgb, in the frame that a renderer interpolates over the grid's
// triangles: (x, y, z) -> round(127.5 * (1 + x)), z outwards. `tangents` come from grid_tangents.
std::vector<uint8_t> tangent_space_map(const DecodedImage& image, const std::vector<float>& tangents,
                                       const ImagePlane& normals);

}  // namespace gim

// Draws pictures anew for other texture coordinates: what lies at each texel of an atlas, and how the rest is filled.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/glb_geometry.h"

namespace gim {

struct AtlasSize {
    uint32_t width = 0, height = 0;
    bool operator==(const AtlasSize&) const = default;
};

// A texel that lies on the surface.
struct AtlasTexel {
    uint32_t index = 0;              // row * width + column
    uint32_t triangle = 0;           // of the arrays
    std::array<float, 3> weights{};  // of its corners
};

// The texels whose centres lie in triangles, each once. O(triangles + texels).
std::vector<AtlasTexel> texels_of(const PrimitiveArrays& arrays, const AtlasSize& size);

// The share of the atlas that triangles cover.
double covered_share(const PrimitiveArrays& arrays);

// Gives texels without a value that of a texel nearby. channels: bytes of a texel. O(texels).
void fill_gaps(std::vector<uint8_t>& pixels, size_t channels, std::vector<bool>& has_value, const AtlasSize& size);

// Places squares of these sides beside each other in a unit square, all scaled alike. They keep a gap, for filters.
std::vector<AtlasPlace> pack_squares(std::span<const double> sides);

}  // namespace gim

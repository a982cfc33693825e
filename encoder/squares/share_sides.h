// Shares the samples of a file among its components.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace gim {

// Returns the side of each component's image, 2^j + 1, at least 5. The images have about as many samples for each piece of
// area, and together as many as one image of `side`: at most a sixth more, apart from images of the least side. Sides are rounded down to 2^j + 1, except that a component that all but deserves `side` gets
// it, so that specks beside a large part do not halve its side. What is left doubles the sides of the sparsest images.
// areas: not negative. side: 2^j + 1. Cost: O(n log n).
std::vector<uint32_t> share_sides(std::span<const double> areas, uint32_t side);

}  // namespace gim

// Turns a foreign geometry image, a bare grid of points, into one of ours. Finds the gluing of its ring by position.
// Gu, Gortler, Hoppe 2002 only remark (section 3.3) that such a search is error-prone. We therefore look for runs of
// edges that match at both ends, longest first, instead of equal points.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/squares/square_image.h"

namespace gim {

// In:  side*side*3 floats, planar (all x, all y, all z), sample (row, column) at row * side + column.
//      weld_tolerance: two ring samples that are one surface point may be this far apart, in object units.
// Out: an image of side 2^j+1; other sides are resampled bilinearly to the next larger one. Mates are welded to
//      bit-equal positions. Ring edges that match nothing are a boundary of the surface. A closed surface faces
//      outwards. An Error names the sample or the side and says what to do.
// Cost: O(side^2 + ring log ring + matching pairs). Deterministic.
Result<SquareImage> import_image(const std::vector<float>& channels, uint32_t side, double weld_tolerance);

// Finds the gluing of the ring and does not change the image. Glues every ring edge to at most one other, which runs
// the opposite way between the same two points. Paths are empty if nothing matches.
Sideband find_gluing(const SquareGrid& image, double weld_tolerance);

}  // namespace gim

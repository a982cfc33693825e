// A geometry image of other people, a bare grid of points, becomes one of ours: the gluing of its ring is found by position.
// There is nothing about this in Gu, Gortler, Hoppe 2002 but the remark (section 3.3) that such a search is error-prone: we
// ask for runs of edges that match in both ends, longest first, instead of for equal points.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/squares/square_image.h"

namespace gim {

// In:  side*side*3 floats, planar (all x, all y, all z), sample (row, column) at row * side + column.
//      weld_tolerance: how far apart, in object units, two ring samples may be that are one surface point.
// Out: side 2^j+1 (other sides are resampled bilinearly to the next larger one), mates welded to bit-equal positions,
//      what matches nothing is a boundary of the surface, turned so that a closed surface has its outside outside.
//      An Error names the sample or the side and tells what to do.
// Cost: O(side^2 + ring log ring + matching pairs). Deterministic.
Result<SquareImage> import_image(const std::vector<float>& planes, uint32_t side, double weld_tolerance);

// The gluing of the ring of an image as it is: every ring edge is glued to at most one other that runs the opposite way
// between the same two points. Empty paths: nothing matches.
Sideband find_gluing(const SquareGrid& image, double weld_tolerance);

}  // namespace gim

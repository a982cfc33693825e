// Finds charts whose map closes a slit: two pieces of border are about a sample apart in the map, but far apart on the
// surface. Masks fill such slits, so the image's triangles bridge them, and no fit can mend that. A chart of a limb
// that is cut open along its length is an example.
#pragma once

#include <vector>

#include "encoder/charts/atlas.h"
#include "encoder/charts/multi_chart_image.h"
#include "encoder/charts/pack.h"

namespace gim {

// Marks every chart that has a slit with a face on each side of its worst place (ChartMap::crossing). split_charts()
// then parts the two. `spacing`: of the samples in the maps. Out: the charts, ascending. O(sum of squared borders).
std::vector<uint32_t> find_slits(double spacing, Atlas& atlas);

// Finds charts that find_slits() missed: a long edge of the image spans a gap, and its middle is more than a sample's
// spacing off the surface. Marks them in the same way. `surface`: what the charts were cut from. O(triangles), and a
// search for each long one.
std::vector<uint32_t> find_bridges(const MultiChartImage& image, const Packing& packing, const Mesh& surface,
                                   Atlas& atlas);

}  // namespace gim

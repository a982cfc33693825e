// Finds charts whose map closes a slit in them: two stretches of border that come nearer to each other in the map than a
// sample, far from each other on the surface. Masks fill such slits, and the image's triangles bridge them, which no fit
// can mend. A chart of a limb, cut open along it, does so.
#pragma once

#include <vector>

#include "encoder/charts/atlas.h"
#include "encoder/charts/multi_chart_image.h"
#include "encoder/charts/pack.h"

namespace gim {

// `spacing`: of the samples in the maps. Marks every chart with a slit by a face on each side of the worst place
// (ChartMap::crossing), for split_charts() to part them there. Out: the charts, ascending. O(sum of squared borders).
std::vector<uint32_t> find_slits(double spacing, Atlas& atlas);

// What slipped through: charts with triangles of the image that span a gap, their middle off the surface by more than a
// sample's spacing. Marked in the same way. `surface`: that of the charts. O(triangles), and a search for each long one.
std::vector<uint32_t> find_bridges(const MultiChartImage& image, const Packing& packing, const Mesh& surface,
                                   Atlas& atlas);

}  // namespace gim

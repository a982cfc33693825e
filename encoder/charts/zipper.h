// Closes the cracks between packed charts: finds the sample of every cut-node, snaps border samples onto the cut-paths,
// and unifies the two sides of each.
//
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.5. We differ: (1) cut-node
// samples are found for all nodes of a chart at once by dynamic programming (least sum of squared distances in the map
// that keeps their order around the border and leaves a sample between neighbours where it can), not one by one; (2) so
// is the zipper: of all lock-step traversals the one that moves samples least, not a greedy one; (3) a unified point lies
// at the mean of where its samples were along the path, not at one of them, and points keep a distance along the path.
#pragma once

#include <vector>

#include "encoder/charts/chart_parametrize.h"
#include "encoder/charts/chart_set.h"
#include "encoder/charts/multi_chart_image.h"
#include "encoder/charts/pack.h"

namespace gim {

// In:  the image as sampled, and what it was sampled from. Every chart's mask is a disk with at least two border samples
//      per path.
// Out: the same image with border samples moved onto the cut-paths and the seams filled in: samples that are one surface
//      point are at bit-equal positions. A few border samples are taken out of the mask where the surface would come
//      together along an edge otherwise. Fails where that does not do: another packing may.
// Cost: O(sum over seams of the product of the lengths of both sides).
Result<MultiChartImage> zip(MultiChartImage image, const std::vector<Chart>& charts, const std::vector<ChartMap>& maps,
                            const Packing& packing);

}  // namespace gim
